"""Closed triangle meshes as half-edges.

Half-edge ``3 f + i`` runs from corner i of face f to the next one. A dead half-edge or vertex is -1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


class HalfEdges(NamedTuple):
    """Connectivity of a closed two-manifold."""

    start: IntArray
    """(3 m,) vertex where a half-edge starts."""
    twin: IntArray
    """(3 m,) the half-edge that runs the other way."""
    out: IntArray
    """(n,) one half-edge that starts at a vertex."""


def build(V: FloatArray, F: IntArray) -> tuple[HalfEdges, FloatArray]:
    """Connect the faces of a closed mesh.

    Where sheets touch in an edge or a vertex they are separated, so that the result is a two-manifold.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces; every edge must be run through as often one way as the other.

    Returns
    -------
    mesh : HalfEdges
        Its connectivity.
    V : (k, 3) ndarray
        Vertices, with a copy for every sheet beyond the first that touches there.

    Raises
    ------
    ValueError
        If the mesh is not closed or not consistently oriented.
    """
    a, b = F.ravel(), np.roll(F, -1, axis=1).ravel()
    key = np.minimum(a, b).astype(np.int64) * len(V) + np.maximum(a, b)
    order = np.argsort(key, kind="stable")
    _, first, count = np.unique(key[order], return_index=True, return_counts=True)
    twin = np.full(len(a), -1, dtype=np.int64)
    plain = first[count == 2]
    twin[order[plain]], twin[order[plain + 1]] = order[plain + 1], order[plain]
    for i, c in zip(first[count != 2], count[count != 2]):
        _pair_sheets(V, F, a, order[i : i + c], twin)
    if (twin < 0).any() or (a[twin] != b).any():
        raise ValueError("F must be a closed, consistently oriented mesh; an edge has no opposite")
    start, origin = _separate_fans(a.astype(np.int64), twin, len(V))
    out = np.zeros(len(origin), dtype=np.int64)
    out[start] = np.arange(len(start))
    return HalfEdges(start, twin, out), V[origin]


def _pair_sheets(V: FloatArray, F: IntArray, start: IntArray, edges: IntArray, twin: IntArray) -> None:
    """Pair the faces around an edge of several sheets across the solid between them."""
    lo = start[edges[0]]
    hi = start[edges[start[edges] != lo][0]] if (start[edges] != lo).any() else lo
    axis = V[hi] - V[lo]
    third = V[F[edges // 3, (edges % 3 + 2) % 3]] - V[lo]
    reference = np.cross(axis, third[0])
    side = np.cross(reference, axis)
    angle = np.arctan2(third @ reference / np.linalg.norm(reference), third @ side / np.linalg.norm(side))
    # seen along the edge from lo to hi, the solid lies clockwise of a face that runs from lo to hi
    forward, backward = np.flatnonzero(start[edges] == lo), np.flatnonzero(start[edges] != lo)
    free = list(backward)
    for f in forward:
        turn = [(angle[f] - angle[g]) % (2.0 * np.pi) for g in free]
        if not free:
            break
        g = free.pop(int(np.argmin(turn)))
        twin[edges[f]], twin[edges[g]] = edges[g], edges[f]


@njit(cache=True)
def _separate_fans(start: IntArray, twin: IntArray, n: int) -> tuple[IntArray, IntArray]:
    new = np.full(len(start), -1, dtype=np.int64)
    origin = np.zeros(len(start), dtype=np.int64)
    seen = np.zeros(n, dtype=np.int64)
    count = n
    origin[:n] = np.arange(n)
    for h in range(len(start)):
        if new[h] >= 0:
            continue
        v = start[h]
        label = v
        if seen[v]:
            label = count
            origin[count] = v
            count += 1
        seen[v] = 1
        k = h
        while new[k] < 0:
            new[k] = label
            k = twin[before(k)]
    return new, origin[:count].copy()


def faces(mesh: HalfEdges, V: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return what is alive as vertices and faces.

    Parameters
    ----------
    mesh : HalfEdges
        Connectivity.
    V : (n, 3) float
        Vertices.

    Returns
    -------
    V : (k, 3) ndarray
        Vertices in use.
    F : (m, 3) ndarray
        Faces.
    """
    F = mesh.start.reshape(-1, 3)
    F = F[F[:, 0] >= 0]
    used = np.unique(F)
    index = np.zeros(len(V), dtype=np.int64)
    index[used] = np.arange(len(used))
    return V[used], index[F]


@njit(cache=True, error_model="numpy")
def compact(V: FloatArray, want: FloatArray, mesh: HalfEdges) -> tuple[FloatArray, FloatArray, HalfEdges]:
    """Drop what is dead.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    want : (n,) float
        One number a vertex.
    mesh : HalfEdges
        Connectivity.

    Returns
    -------
    V, want, mesh
        The same, renumbered in the old order.
    """
    v_new, h_new = np.full(len(V), -1, dtype=np.int64), np.full(len(mesh.start), -1, dtype=np.int64)
    n = m = 0
    for v in range(len(V)):
        if mesh.out[v] >= 0:
            v_new[v] = n
            n += 1
    for h in range(len(mesh.start)):
        if mesh.start[h] >= 0:
            h_new[h] = m
            m += 1
    V2, want2, out = np.zeros((n, 3)), np.zeros(n), np.zeros(n, dtype=np.int64)
    start, twin = np.zeros(m, dtype=np.int64), np.zeros(m, dtype=np.int64)
    for v in range(len(V)):
        if v_new[v] >= 0:
            V2[v_new[v]], want2[v_new[v]], out[v_new[v]] = V[v], want[v], h_new[mesh.out[v]]
    for h in range(len(mesh.start)):
        if h_new[h] >= 0:
            start[h_new[h]], twin[h_new[h]] = v_new[mesh.start[h]], h_new[mesh.twin[h]]
    return V2, want2, HalfEdges(start, twin, out)


@njit(cache=True, inline="always")
def after(h: int) -> int:
    """Next half-edge of the same face.

    Parameters
    ----------
    h : int
        Half-edge.

    Returns
    -------
    int
        The half-edge that starts where `h` ends.
    """
    return h + 1 if h % 3 < 2 else h - 2


@njit(cache=True, inline="always")
def before(h: int) -> int:
    """Previous half-edge of the same face.

    Parameters
    ----------
    h : int
        Half-edge.

    Returns
    -------
    int
        The half-edge that ends where `h` starts.
    """
    return h - 1 if h % 3 > 0 else h + 2
