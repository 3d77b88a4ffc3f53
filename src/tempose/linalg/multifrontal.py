"""Numeric factorisation: dense fronts, one a supernode, in postorder."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

_PIVOTS = 32
_TILE = 512


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def factor_fronts(
    indptr: Any,
    indices: Any,
    data: Any,
    first: Any,
    start: Any,
    rows: Any,
    above: Any,
    own: Any,
    below: Any,
    place: Any,
    out: Any,
) -> Any:
    """Factor a symmetric positive definite matrix as block ``L D L^T``.

    Parameters
    ----------
    indptr, indices, data : (n + 1,), (z,), (z,) ndarray
        The matrix in its order of elimination, both triangles.
    first, start, rows, above : ndarray of int
        Supernodes, see `tempose.linalg.symbolic`.
    own, below, place : ndarray of int
        Layout of the blocks, see `padded_rows`.
    out : (place[-1],) ndarray, zeros
        Filled: of each supernode the inverse of its diagonal block, then its panel of L, negative.

    Returns
    -------
    float
        Smallest pivot as a share of its diagonal entry; the factor is worthless if it is not positive.

    Notes
    -----
    Multifrontal method [1]_; the Schur complement of a front waits on a stack for the front of its parent.

    References
    ----------
    .. [1] Duff, Reid, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear Equations",
       ACM TOMS 9, 1983.
    """
    k = len(first) - 1
    local = np.zeros(first[k], dtype=np.int64)
    waiting, top = np.zeros(k, dtype=np.int64), 0
    stack = np.zeros(_stack_size(first, start, above))
    largest = 0
    for s in range(k):
        largest = max(largest, first[s + 1] - first[s] + start[s + 1] - start[s])
    work = np.zeros(largest * largest)
    head, following = np.full(k, -1), np.full(k, -1)
    least = np.inf
    for s in range(k):
        begin, end = first[s], first[s + 1]
        w, m = end - begin, start[s + 1] - start[s]
        mine = rows[start[s] : start[s + 1]]
        F = work[: (w + m) * (w + m)].reshape(w + m, w + m)
        for p in range((w + m) * (w + m)):
            work[p] = 0.0
        for j in range(w):
            local[begin + j] = j
        for r in range(m):
            local[mine[r]] = w + r
        for j in range(begin, end):
            for p in range(indptr[j], indptr[j + 1]):
                if indices[p] >= j:
                    F[j - begin, local[indices[p]]] = data[p]
        child = head[s]
        while child != -1:
            c = start[child + 1] - start[child]
            top = waiting[child]
            _extend_add(
                F, stack[top : top + c * c].reshape(c, c), local, rows[start[child] : start[child + 1]]
            )
            child = following[child]
        least = min(least, _eliminate(F, w))
        if not least > 0.0:
            return least
        panel = place[s] + (below[s] - own[s]) * w
        _store(F, out[place[s] : place[s] + w * w].reshape(w, w), out[panel : panel + m * w].reshape(m, w))
        if m > 0:
            waiting[s] = top
            for a in range(m):
                for b in range(a, m):
                    stack[top + a * m + b] = F[w + a, w + b]
            top += m * m
            t = above[s]
            following[s], head[t] = head[t], s
    return least


@numba.njit(cache=True, nogil=True)
def _stack_size(first: Any, start: Any, above: Any) -> Any:
    """Find the largest sum of Schur complements that wait at the same time."""
    k = len(first) - 1
    freed = np.zeros(k, dtype=np.int64)
    now = most = 0
    for s in range(k):
        now -= freed[s]
        m = start[s + 1] - start[s]
        if m > 0:
            now += m * m
            freed[above[s]] += m * m
        most = max(most, now)
    return most


@numba.njit(cache=True, nogil=True)
def _extend_add(F: Any, U: Any, local: Any, rows: Any) -> None:
    for a in range(len(rows)):
        i = local[rows[a]]
        for b in range(a, len(rows)):
            F[i, local[rows[b]]] += U[a, b]


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def _eliminate(F: Any, w: Any) -> Any:
    """Cholesky of the first w columns in place; row p of F holds column p of L from the diagonal on."""
    f = F.shape[0]
    share = np.inf
    original = np.zeros(w)
    for p in range(w):
        original[p] = F[p, p]
    for p0 in range(0, w, _PIVOTS):
        p1 = min(p0 + _PIVOTS, w)
        for p in range(p0, p1):
            for q in range(p0, p):
                a = F[q, p]
                for i in range(p, f):
                    F[p, i] -= a * F[q, i]
            d = F[p, p]
            if not (d > 0.0 and original[p] > 0.0):
                return -1.0
            share = min(share, d / original[p])
            scale = 1.0 / np.sqrt(d)
            for i in range(p, f):
                F[p, i] *= scale
        for tile in range(p1, f, _TILE):
            edge = min(tile + _TILE, f)
            for k in range(p1, edge):
                _subtract(F, p0, p1, k, max(k, tile), edge)
    return share


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def _subtract(F: Any, p0: Any, p1: Any, k: Any, lo: Any, hi: Any) -> None:
    """Subtract from row k the part of the pivot rows p0 to p1, four at a time."""
    q = p0
    while q + 4 <= p1:
        a, b, c, d = F[q, k], F[q + 1, k], F[q + 2, k], F[q + 3, k]
        for i in range(lo, hi):
            F[k, i] -= a * F[q, i] + b * F[q + 1, i] + c * F[q + 2, i] + d * F[q + 3, i]
        q += 4
    while q < p1:
        a = F[q, k]
        for i in range(lo, hi):
            F[k, i] -= a * F[q, i]
        q += 1


@numba.njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def _store(F: Any, D: Any, P: Any) -> None:
    """Turn Cholesky rows into the inverse D of the diagonal block and the panel -P of a unit block factor."""
    m, w = P.shape
    T = np.zeros((w, w))
    # T = inverse of the lower triangle, row by row
    for i in range(w):
        T[i, i] = 1.0 / F[i, i]
        for p in range(i):
            a = F[p, i] * T[i, i]
            for j in range(p + 1):
                T[i, j] -= a * T[p, j]
    for p in range(w):
        for i in range(w):
            a = T[p, i]
            for j in range(p + 1):
                D[i, j] += a * T[p, j]
    for r in range(m):
        for p in range(w):
            a = F[p, w + r]
            for j in range(p + 1):
                P[r, j] -= a * T[p, j]
