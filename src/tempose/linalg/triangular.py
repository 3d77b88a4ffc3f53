"""Triangular solves with many right-hand sides, vectorised across the sides."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def solve_ldl(indptr: Any, indices: Any, data: Any, inverse_diagonal: Any, X: Any) -> None:
    """Solve ``L D L^T Y = X`` in place for unit lower triangular L.

    Parameters
    ----------
    indptr, indices, data : (n + 1,), (z,), (z,) ndarray
        The strictly lower part of L in CSC form.
    inverse_diagonal : (n,) ndarray
        ``1 / D``.
    X : (n, k) ndarray, C-contiguous
        Right-hand sides in, solutions out; a row holds all k sides of one unknown, so that one entry
        of L is loaded once for all of them.
    """
    n, k = X.shape
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            a = data[p]
            for c in range(k):
                X[i, c] -= a * X[j, c]
    for j in range(n - 1, -1, -1):
        d = inverse_diagonal[j]
        for c in range(k):
            X[j, c] *= d
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            a = data[p]
            for c in range(k):
                X[j, c] -= a * X[i, c]


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def solve_ldl_3(indptr: Any, indices: Any, data: Any, inverse_diagonal: Any, X: Any) -> None:
    """Solve as `solve_ldl` for exactly three sides, kept in registers: one frame, twice as fast.

    Parameters
    ----------
    indptr, indices, data : (n + 1,), (z,), (z,) ndarray
        The strictly lower part of L in CSC form.
    inverse_diagonal : (n,) ndarray
        ``1 / D``.
    X : (n, 3) ndarray, C-contiguous
        Right-hand sides in, solutions out.
    """
    n = X.shape[0]
    for j in range(n):
        x, y, z = X[j, 0], X[j, 1], X[j, 2]
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            X[i, 0] -= data[p] * x
            X[i, 1] -= data[p] * y
            X[i, 2] -= data[p] * z
    for j in range(n - 1, -1, -1):
        x, y, z = X[j, 0] * inverse_diagonal[j], X[j, 1] * inverse_diagonal[j], X[j, 2] * inverse_diagonal[j]
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            x -= data[p] * X[i, 0]
            y -= data[p] * X[i, 1]
            z -= data[p] * X[i, 2]
        X[j, 0], X[j, 1], X[j, 2] = x, y, z


@numba.njit(cache=True, nogil=True)
def scatter_rows(X: Any, permutation: Any, out: Any) -> None:
    """Write ``out[permutation[i]] = X[i]`` row by row.

    Parameters
    ----------
    X : (n, k) ndarray
        Rows in the old order.
    permutation : (n,) int ndarray
        New place of each row.
    out : (n, k) ndarray
        Rows in the new order.
    """
    for i in range(X.shape[0]):
        for c in range(X.shape[1]):
            out[permutation[i], c] = X[i, c]


def strictly_lower(L: Any) -> tuple[IntArray, IntArray, FloatArray]:
    """Strip the unit diagonal from a CSC factor.

    Parameters
    ----------
    L : (n, n) scipy.sparse.csc_array
        Unit lower triangular.

    Returns
    -------
    indptr, indices, data : ndarray
        CSC arrays of the strictly lower part, rows ascending in each column.
    """
    L = L.tocsc(copy=True)
    L.setdiag(0.0)
    L.eliminate_zeros()
    L.sort_indices()
    return L.indptr.astype(np.int64), L.indices.astype(np.int32), L.data.astype(np.float64)
