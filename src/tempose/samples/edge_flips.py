"""A pass over all edges of a half-edge mesh that flips the ill-shaped."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.samples.edge_measures import cotangent, normal
from tempose.samples.edge_operations import flip
from tempose.samples.half_edges import HalfEdges, before
from tempose.typing import FloatArray


@njit(cache=True, error_model="numpy")
def flip_edges(V: FloatArray, mesh: HalfEdges, delaunay: bool) -> int:
    """Flip edges, in place, where the surface is flat enough to bear it.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    mesh : HalfEdges
        Connectivity.
    delaunay : bool
        Flip where opposite angles sum to more than 180 degrees; otherwise where it brings the numbers of
        neighbours closer to six.

    Returns
    -------
    int
        How many were flipped.
    """
    valence = np.zeros(len(V), dtype=np.int64)
    for h in range(len(mesh.start)):
        if mesh.start[h] >= 0:
            valence[mesh.start[h]] += 1
    flipped = 0
    n0, n1, n2, n3 = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    for h in range(len(mesh.start)):
        t = mesh.twin[h]
        if mesh.start[h] < 0 or h > t:
            continue
        a, b, c, d = mesh.start[h], mesh.start[t], mesh.start[before(h)], mesh.start[before(t)]
        if delaunay:
            better = cotangent(V, a, c, b) + cotangent(V, a, d, b) < -1e-3
        else:
            gain = valence[a] + valence[b] - valence[c] - valence[d]
            better = gain > 2
        if not better or min(valence[a], valence[b]) <= 3 or _joined(mesh, before(h), d):
            continue
        normal(V, a, b, c, n0)
        normal(V, b, a, d, n1)
        if normal(V, a, d, c, n2) <= 0.0 or normal(V, d, b, c, n3) <= 0.0:
            continue
        limit = 0.9 if delaunay else 0.7
        if min(np.dot(n2, n3), np.dot(n0, n2), np.dot(n1, n3), np.dot(n0, n3), np.dot(n1, n2)) < limit:
            continue
        flip(mesh, h)
        valence[a] -= 1
        valence[b] -= 1
        valence[c] += 1
        valence[d] += 1
        flipped += 1
    return flipped


@njit(cache=True, error_model="numpy")
def _joined(mesh: HalfEdges, h: int, other: int) -> bool:
    k = h
    while True:
        if mesh.start[mesh.twin[k]] == other:
            return True
        k = mesh.twin[before(k)]
        if k == h:
            return False
