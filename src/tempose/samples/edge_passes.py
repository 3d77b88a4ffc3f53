"""Passes over all edges of a half-edge mesh that split the long and collapse the short."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.samples.edge_measures import edge_length, normal
from tempose.samples.edge_operations import collapse, split
from tempose.samples.half_edges import HalfEdges, after, before
from tempose.typing import FloatArray, IntArray

LONG, SHORT = 4.0 / 3.0, 4.0 / 5.0
"""Edges outside these multiples of the wanted length come closer to it when split or collapsed."""


@njit(cache=True, error_model="numpy")
def count_long(V: FloatArray, want: FloatArray, mesh: HalfEdges) -> int:
    """Count the edges that `split_long` would split.

    Parameters
    ----------
    V, want, mesh
        As for `split_long`.

    Returns
    -------
    int
        At least as many as there are.
    """
    count = 0
    for h in range(len(mesh.start)):
        a = mesh.start[h]
        if a >= 0 and h < mesh.twin[h]:
            b = mesh.start[mesh.twin[h]]
            if edge_length(V, a, b) > LONG * 0.5 * (want[a] + want[b]):
                count += 1
    return count


@njit(cache=True, error_model="numpy")
def split_long(V: FloatArray, want: FloatArray, mesh: HalfEdges, n: int) -> int:
    """Split edges that are longer than wanted, in place; new edges are left for the next pass.

    Parameters
    ----------
    V : (capacity, 3) float
        Vertices, with room behind the first `n`.
    want : (capacity,) float
        Wanted edge length at the vertices, metres.
    mesh : HalfEdges
        Connectivity, with room for two faces for each new vertex behind the present ones.
    n : int
        Vertices in use; faces in use are ``2 n - 4`` and a constant for the genus.

    Returns
    -------
    int
        Vertices in use afterwards.
    """
    room = len(V) - n
    face = len(mesh.start) // 3 - 2 * room
    for h in range(3 * face):
        if h > mesh.twin[h]:
            continue
        a, b = mesh.start[h], mesh.start[mesh.twin[h]]
        if n < len(V) and edge_length(V, a, b) > LONG * 0.5 * (want[a] + want[b]):
            V[n] = 0.5 * (V[a] + V[b])
            want[n] = 0.5 * (want[a] + want[b])
            split(mesh, h, n, face)
            n += 1
            face += 2
    return n


@njit(cache=True, error_model="numpy")
def collapse_short(V: FloatArray, want: FloatArray, mesh: HalfEdges, flatness: float) -> None:
    """Collapse edges that are shorter than wanted, in place, unless that would fold or pinch the surface.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    want : (n,) float
        Wanted edge length at the vertices, metres.
    mesh : HalfEdges
        Connectivity.
    flatness : float
        Least cosine between the normals of a triangle before and after.
    """
    stamp = np.full(len(V), -1, dtype=np.int64)
    middle = np.zeros(3)
    for h in range(len(mesh.start)):
        a = mesh.start[h]
        if a < 0 or h > mesh.twin[h]:
            continue
        b = mesh.start[mesh.twin[h]]
        if edge_length(V, a, b) >= SHORT * 0.5 * (want[a] + want[b]):
            continue
        middle[:] = 0.5 * (V[a] + V[b])
        if (
            _linked(mesh, h, stamp)
            and _stays_flat(V, want, mesh, h, b, middle, flatness)
            and _stays_flat(V, want, mesh, mesh.twin[h], a, middle, flatness)
        ):
            V[b] = middle
            want[b] = 0.5 * (want[a] + want[b])
            collapse(mesh, h)


@njit(cache=True, error_model="numpy")
def _linked(mesh: HalfEdges, h: int, stamp: IntArray) -> bool:
    """Link condition: the ends share two neighbours only, and neither of these has just three."""
    start, twin = mesh.start, mesh.twin
    t = twin[h]
    k = h
    while True:
        stamp[start[twin[k]]] = h
        k = twin[before(k)]
        if k == h:
            break
    shared = 0
    k = t
    while True:
        shared += stamp[start[twin[k]]] == h
        k = twin[before(k)]
        if k == t:
            break
    return shared == 2 and _valence(mesh, before(h)) > 3 and _valence(mesh, before(t)) > 3


@njit(cache=True, error_model="numpy")
def _valence(mesh: HalfEdges, h: int) -> int:
    count, k = 0, h
    while True:
        count += 1
        k = mesh.twin[before(k)]
        if k == h:
            return count


@njit(cache=True, error_model="numpy")
def _stays_flat(
    V: FloatArray, want: FloatArray, mesh: HalfEdges, h: Any, other: Any, to: FloatArray, flatness: float
) -> bool:
    """Whether the start of `h` may move: no triangle around it turns over, no edge gets too long."""
    a = mesh.start[h]
    k = h
    old, new, here = np.zeros(3), np.zeros(3), V[a].copy()
    while True:
        b, c = mesh.start[after(k)], mesh.start[before(k)]
        if b != other and c != other:
            normal(V, a, b, c, old)
            V[a] = to
            normal(V, a, b, c, new)
            far = edge_length(V, a, b) > LONG * 0.5 * (want[a] + want[b])
            V[a] = here
            if far or np.dot(old, new) < flatness:
                return False
        k = mesh.twin[before(k)]
        if k == h:
            return True
