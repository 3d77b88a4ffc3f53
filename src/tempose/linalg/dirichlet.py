"""Harmonic functions with prescribed values."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose._validate import as_floats, as_indices
from tempose.linalg.cholesky import Backend, SparseCholesky
from tempose.typing import FloatArray, IntArray


def harmonic_extension(L: Any, known: IntArray, values: Any, backend: Backend = "numba") -> FloatArray:
    """Extend values to all unknowns so that ``L x = 0`` away from the known ones.

    Parameters
    ----------
    L : (n, n) sparse array
        Positive semidefinite Laplacian.
    known : (c,) int
        Distinct indices with prescribed values; every component of L needs one.
    values : (c, k) ndarray or sparse array
        Their values.
    backend : {"numba", "splu", "cholespy"}, default "numba"
        See `SparseCholesky`.

    Returns
    -------
    (n, k) ndarray
        Values everywhere; at `known` exactly as given.

    Raises
    ------
    ValueError
        If a component has no known value, an index is named twice or out of range, or `values` has another
        number of rows.
    """
    L = sp.csr_array(L)
    n = L.shape[0]
    known = as_indices(known, "known", ("c",), limit=n)
    dense = as_floats(values.toarray() if sp.issparse(values) else values, "values", (len(known), "k"))
    is_known = np.zeros(n, dtype=bool)
    is_known[known] = True
    if is_known.sum() < len(known):
        twice = int(np.flatnonzero(np.bincount(known) > 1)[0])
        raise ValueError(f"known must hold distinct indices, got {twice} more than once")
    free = np.flatnonzero(~is_known)
    x = np.zeros((n, dense.shape[1]))
    x[known] = dense
    if len(free):
        coupled = L[free][:, known] @ dense
        x[free] = SparseCholesky(L[free][:, free], backend).solve(-coupled)
    return x
