"""Centres of connected pieces, and vertices put about them."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.linalg.lanes import item


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
def write_vertices(X: Any, at: Any, row: Any, component: Any, weights: Any, to: Any, out: Any) -> None:
    """Move every piece so that its centre comes to its place.

    Parameters
    ----------
    X : (n + 1, k) ndarray
        Solutions, in rows of the factor.
    at : int
        First of three columns.
    row : (n,) int ndarray
        Row of each vertex.
    component, weights : (n,) ndarray
        As in `centres`.
    to : (pieces, 3) ndarray
        Places of the centres.
    out : (n, 3) ndarray
        Written.
    """
    shift = np.zeros(to.shape)
    for v in range(len(row)):
        c, w, r = component[v], weights[v], row[v]
        for d in range(3):
            x = X[r, at + d]
            out[v, d] = x
            shift[c, d] += w * x
    for c in range(len(to)):
        for d in range(3):
            shift[c, d] = to[c, d] - shift[c, d]
    for v in range(len(row)):
        c = component[v]
        for d in range(3):
            out[v, d] += shift[c, d]
