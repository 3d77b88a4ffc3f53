"""Shortest paths over the surface from one bone's marks to another's.

Second remedy of section 4.3 of the paper: along a path between marks that turn far against each other the
rotation is interpolated by SLERP, the long way round if the limb went that way, and what the path touches is
held to it. The vertices of a path share stations, one column of the solver each.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from tempose.geometry import edge_list, vertex_adjacency
from tempose.rotations import conjugate, multiply
from tempose.transfer.turns.columns import Between
from tempose.typing import FloatArray, IntArray

PATHS = 6
"""Paths round a limb: with a single one its other side still collapses."""
STATIONS = 8
"""Columns along a path; between them the rotation is that of the nearest."""
NEAR_HALF_TURN = 0.5
"""A bone gets paths where w against its parent falls below this (120 degrees)."""


@dataclass(frozen=True)
class SurfacePath:
    """A path along edges of a mesh."""

    vertices: IntArray
    """(p,) from start to end."""
    share: FloatArray
    """(p,) arc length from the start, as a share of the whole."""


def shortest_paths(
    V: FloatArray, F: IntArray, start: IntArray, end: IntArray, count: int = PATHS
) -> list[SurfacePath]:
    """Join two groups of vertices by shortest paths along edges.

    Parameters
    ----------
    V : (n, 3) float
        Vertices of one connected surface, metres.
    F : (m, 3) int
        Faces.
    start, end : (a,), (b,) int
        Marked vertices.
    count : int, default 6
        Number of paths at most; their ends are spread over the part of `end` that lies nearest.

    Returns
    -------
    list of SurfacePath
        Each from a vertex of `start` to one of `end`, touching neither in between; none where the surface
        does not join them.
    """
    i, j = edge_list(F).T
    length = np.linalg.norm(V[i] - V[j], axis=1) + 1e-12
    graph: Any = sp.coo_array((length, (i, j)), shape=(len(V), len(V))).tocsr()
    # out of `end` there is no way on, so that a path stops at the first of its vertices
    stops = np.ones(len(V))
    stops[end] = 0.0
    graph = sp.diags_array(stops) @ (graph + graph.T)
    graph.eliminate_zeros()
    away, before, _ = dijkstra(graph, indices=start, min_only=True, return_predecessors=True)
    reached = end[np.isfinite(away[end])]
    if len(reached) == 0:
        return []
    ring = reached[away[reached] <= 2 * float(away[reached].min())]
    return [_traced(int(v), away, before) for v in _spread_out(V, ring, away, count)]


def _spread_out(V: FloatArray, ring: IntArray, away: FloatArray, count: int) -> list[int]:
    """Choose the nearest vertex, then each time the one farthest from all chosen ones."""
    chosen = [int(ring[away[ring].argmin()])]
    gap = np.linalg.norm(V[ring] - V[chosen[0]], axis=1)
    while len(chosen) < count and gap.max() > 0:
        chosen.append(int(ring[gap.argmax()]))
        gap = np.minimum(gap, np.linalg.norm(V[ring] - V[chosen[-1]], axis=1))
    return chosen


def _traced(v: int, away: FloatArray, before: IntArray) -> SurfacePath:
    vertices = [v]
    while before[vertices[-1]] >= 0:
        vertices.append(int(before[vertices[-1]]))
    path = np.array(vertices[::-1])
    return SurfacePath(path, away[path] / max(float(away[v]), 1e-12))


def path_columns(
    V: FloatArray,
    F: IntArray,
    marked: IntArray,
    bones: IntArray,
    parents: IntArray,
    Q: FloatArray,
    but: frozenset[int] = frozenset(),
) -> tuple[tuple[Between, ...], IntArray, IntArray]:
    """Lay paths between every bone that comes near half a turn against its parent, and that parent.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, metres, seams closed.
    F : (m, 3) int
        Faces.
    marked : (k,) int
        Marked vertices.
    bones : (k,) int
        Bone of each.
    parents : (B,) int
        Tree of bones.
    Q : (T, B, 4) float
        Rotations of the bones, signs agreeing.
    but : frozenset of int
        Bones that get no path, because rings spread their twist already.

    Returns
    -------
    between : tuple of Between
        Rotations along the paths, by SLERP between parent and bone.
    vertices, columns : (c,) ndarray of int
        Vertices that paths hold and which of `between` each carries. None of them is marked already.
    """
    between: list[Between] = []
    held: dict[int, int] = {}
    taken = set(marked.tolist())
    touching: Any = sp.csr_array(vertex_adjacency(F, len(V)))
    for b in turning_far(Q, parents):
        above = int(parents[b])
        while above >= 0 and not (bones == above).any():
            above = int(parents[above])
        if b in but or above < 0 or not (bones == b).any():
            continue
        first = len(between)
        between += [Between(b, above, b, (s + 0.5) / STATIONS - 1) for s in range(STATIONS)]
        for path in shortest_paths(V, F, marked[bones == above], marked[bones == b]):
            station = np.minimum((path.share * STATIONS).astype(int), STATIONS - 1)
            # what a path touches takes the station of the path's vertex next to it
            for v, s in zip(path.vertices, station):
                for u in (int(v), *touching.indices[touching.indptr[v] : touching.indptr[v + 1]].tolist()):
                    if u not in taken:
                        held.setdefault(u, first + int(s))
    vertices = np.array(sorted(held), dtype=np.int64)
    return tuple(between), vertices, np.array([held[int(v)] for v in vertices], dtype=np.int64)


def turning_far(Q: FloatArray, parents: IntArray) -> list[int]:
    """Find the bones that turn by more than 120 degrees against their parent in some frame.

    Parameters
    ----------
    Q : (T, B, 4) float
        Rotations, signs agreeing and continuous in time.
    parents : (B,) int
        Tree of bones.

    Returns
    -------
    list of int
        Bones.
    """
    above = np.where(parents < 0, 0, parents)
    w = multiply(conjugate(Q[:, above]), Q)[..., 0].min(axis=0)
    return [int(b) for b in np.flatnonzero((w < NEAR_HALF_TURN) & (parents >= 0))]
