"""Centres of connected pieces, and vertices put about them."""

from __future__ import annotations

from typing import Any

import numba

from tempose.linalg.lanes import item

TILE = 64


@numba.njit(cache=True, nogil=True)
def centres(V: Any, component: Any, weights: Any, out: Any) -> None:
    """Weighted mean of the vertices of every piece.

    Parameters
    ----------
    V : (3 n,) ndarray
        Vertices.
    component : (n,) int ndarray
        Piece of each.
    weights : (n,) ndarray
        Weight of each; sums to 1 in every piece.
    out : (pieces, 3) ndarray
        Written.
    """
    out[:] = 0.0
    for v in range(len(weights)):
        c, w = component[v], weights[v]
        for d in range(3):
            out[c, d] += w * item(V, 3 * v + d)


@numba.njit(cache=True, nogil=True)
def write_vertices(X: Any, row: Any, component: Any, weights: Any, to: Any, out: Any) -> None:
    """Move every piece so that its centre comes to its place.

    Parameters
    ----------
    X : (n + 1, k) ndarray
        Solutions, in rows of the factor; frame t has the columns 3 t to 3 t + 3.
    row : (n,) int ndarray
        Row of each vertex.
    component, weights : (n,) ndarray
        As in `centres`.
    to : (pieces, 3 T) ndarray
        Places of the centres.
    out : (T, n, 3) ndarray
        Written.
    """
    n, columns = len(row), to.shape[1]
    shift = to.copy()
    for v in range(n):
        c, w, r = component[v], weights[v], row[v]
        for k in range(columns):
            shift[c, k] -= w * X[r, k]
    # some vertices at a time: their rows stay in the cache while the frames are written one by one
    for begin in range(0, n, TILE):
        for t in range(len(out)):
            for v in range(begin, min(begin + TILE, n)):
                c, r = component[v], row[v]
                for d in range(3):
                    out[t, v, d] = X[r, 3 * t + d] + shift[c, 3 * t + d]
