"""Harmonic scalar fields, eq. (2): rotations known at marks, interpolated over the whole mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose.linalg import SparseCholesky
from tempose.typing import FloatArray, IntArray

DENSE_COLUMNS = 256
"""Up to so many independent rotations the fields are kept as one dense basis."""


class HarmonicFields:
    """Interpolate B rotations, each prescribed on the vertices of its marked faces.

    By linearity all marks that share a rotation share one column: ``q = W Q``. The basis W is solved once;
    a frame is a thin matrix product.

    Parameters
    ----------
    L : (n, n) sparse array
        Positive semidefinite Laplacian with non-negative weights, one connected component.
    vertices : (k,) int
        Marked vertices; one that carries several rotations takes their mean.
    columns : (k,) int
        Which of the B rotations each carries.
    n_columns : int
        Number of rotations B.
    order : (n,) int, optional
        Order of elimination of L, found if not given.

    Raises
    ------
    ValueError
        If nothing is marked.
    """

    def __init__(
        self, L: Any, vertices: IntArray, columns: IntArray, n_columns: int, order: IntArray | None = None
    ) -> None:
        if len(vertices) == 0:
            raise ValueError("pairs must mark at least one face of the target, got none")
        n = L.shape[0]
        counts = sp.coo_array((np.ones(len(vertices)), (vertices, columns)), shape=(n, n_columns)).tocsr()
        self.known = np.unique(vertices)
        marked = counts[self.known]
        self._marked: Any = sp.diags_array(1.0 / np.asarray(marked.sum(axis=1)).ravel()) @ marked
        is_free = np.ones(n, dtype=bool)
        is_free[self.known] = False
        self._free = np.flatnonzero(is_free)
        self._n = n
        if len(self._free):
            L = sp.csr_array(L)
            self._coupling: Any = -L[self._free][:, self.known]
            if order is not None:
                order = (np.cumsum(is_free) - 1)[order[is_free[order]]]
            self._solver = SparseCholesky(L[self._free][:, self._free], order=order)
        self.basis: FloatArray | None = None
        """(n, B) weights, rows sum to 1; None where B is too large to keep them."""
        if n_columns <= DENSE_COLUMNS:
            self.basis = self._extend(self._marked.toarray())

    def _extend(self, values: FloatArray) -> FloatArray:
        out = np.zeros((self._n, values.shape[1]))
        out[self.known] = values
        if len(self._free):
            out[self._free] = self._solver.solve(self._coupling @ values)
        return out

    def interpolate(self, Q: FloatArray) -> FloatArray:
        """Spread rotations over the mesh.

        Parameters
        ----------
        Q : (B, c) float
            Values of every rotation; the c columns are components and frames.

        Returns
        -------
        (n, c) ndarray
            Values at the vertices, exact at the marks.
        """
        if self.basis is not None:
            return self.basis @ Q
        return self._extend(self._marked @ Q)
