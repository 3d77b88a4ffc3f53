"""Extra edges: links that hold separate pieces together, inner edges that hold the volume."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from tempose.geometry import cotangent_laplacian, vertex_areas, vertex_normals
from tempose.transfer.solver.thin import facing_through
from tempose.typing import BoolArray, FloatArray, IntArray

LINK_WEIGHT = 5.0
LINK_RADIUS = 0.003
SHELL = 0.01
_LOOKS = 8
_MOST_LINKS = 40
_NO_HOLD = 1e-9
_FIRST_STEP, _GROWTH, _NEAR = 0.003, 1.2, 6


@dataclass(frozen=True)
class ExtraEdges:
    """Weighted vertex pairs beside the edges of the faces."""

    pairs: IntArray
    """(e, 2) int."""
    weights: FloatArray
    """(e,) float, in units of cotangent weights."""

    @staticmethod
    def none() -> ExtraEdges:
        """Return no edges at all."""
        return ExtraEdges(np.zeros((0, 2), dtype=np.int64), np.zeros(0))

    def __add__(self, other: ExtraEdges) -> ExtraEdges:
        """Join two lists of edges."""
        return ExtraEdges(np.concatenate([self.pairs, other.pairs]), np.r_[self.weights, other.weights])


def link_pieces(V: FloatArray, F: IntArray) -> ExtraEdges:
    """Join the pieces of a mesh by links until it is one component.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, already welded.
    F : (m, 3) int
        Faces; degenerate ones hold nothing together.

    Returns
    -------
    ExtraEdges
        Links: between vertices of different pieces nearer than 0.3 % of the diagonal, then from the
        smallest group that is still apart to what is nearest to it. Empty for a mesh of one piece.
    """
    count, piece = connected_components(abs(cotangent_laplacian(V, F)) > _NO_HOLD, directed=False)
    if count == 1:
        return ExtraEdges.none()
    pairs = _loose_pairs(V, piece)
    piece = _merge(piece, pairs)
    diagonal = float(np.linalg.norm(np.ptp(V, axis=0)))
    pairs = np.concatenate([pairs, _near_pairs(V, piece, LINK_RADIUS * diagonal)])
    groups = _merge(piece, pairs)
    while groups.max() > 0:
        pairs = np.concatenate([pairs, _nearest_pairs(V, groups)])
        groups = _merge(piece, pairs)
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    return ExtraEdges(pairs, np.full(len(pairs), LINK_WEIGHT))


def _loose_pairs(V: FloatArray, piece: IntArray) -> IntArray:
    """Tie every vertex that no sound face holds to the nearest one that is held."""
    held = np.bincount(piece)[piece] > 1
    loose = np.flatnonzero(~held)
    if held.sum() == 0 or len(loose) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    inside = np.flatnonzero(held)
    return np.column_stack([loose, inside[_query(V[inside], V[loose], 1)[1][:, 0]]]).astype(np.int64)


def _query(points: FloatArray | KDTree, at: FloatArray, k: int) -> tuple[FloatArray, IntArray]:
    tree = points if isinstance(points, KDTree) else KDTree(points)
    distance, index = tree.query(at, k=k)
    return np.asarray(distance).reshape(len(at), k), np.asarray(index).reshape(len(at), k)


def _near_pairs(V: FloatArray, piece: IntArray, radius: float) -> IntArray:
    """Pair each vertex with the nearest vertex of each other piece within `radius`."""
    pairs = KDTree(V).query_pairs(radius, output_type="ndarray")
    pairs = pairs[piece[pairs[:, 0]] != piece[pairs[:, 1]]]
    both = np.concatenate([pairs, pairs[:, ::-1]])
    gap = np.linalg.norm(V[both[:, 0]] - V[both[:, 1]], axis=1)
    order = np.lexsort((gap, piece[both[:, 1]], both[:, 0]))
    both = both[order]
    _, first = np.unique(np.column_stack([both[:, 0], piece[both[:, 1]]]), axis=0, return_index=True)
    return both[first].astype(np.int64)


def _merge(piece: IntArray, pairs: IntArray) -> IntArray:
    """Label the groups of pieces that the pairs join, the largest group first."""
    k = int(piece.max()) + 1
    ends = piece[pairs]
    graph = sp.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(k, k))
    joined = connected_components(graph, directed=False)[1]
    labels = joined[piece]
    sizes = np.bincount(labels)
    rank = np.zeros(len(sizes), dtype=np.int64)
    rank[np.argsort(-sizes, kind="stable")] = np.arange(len(sizes))
    return rank[labels]


def _nearest_pairs(V: FloatArray, groups: IntArray) -> IntArray:
    """Pair the smallest group with what is nearest to it outside."""
    mine = np.flatnonzero(groups == groups.max())
    rest = np.flatnonzero(groups != groups.max())
    distance, near = _query(V[rest], V[mine], 1)
    gap, index = distance[:, 0], near[:, 0]
    order = np.argsort(gap, kind="stable")[:_MOST_LINKS]
    order = order[gap[order] <= 1.5 * gap[order[0]] + 1e-12]
    return np.column_stack([mine[order], rest[index[order]]]).astype(np.int64)


def inner_edges(V: FloatArray, F: IntArray, strength: float | FloatArray) -> ExtraEdges:
    """Join each vertex to the one opposite it through the body, so that bends keep their volume.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, closed surface with outward normals.
    F : (m, 3) int
        Faces.
    strength : float or (n,) float
        0 for none; 1 holds most of the volume. It may differ from vertex to vertex.

    Returns
    -------
    ExtraEdges
        ``w = strength_i * 4 A_i / |v_i - v_j|^2`` with A_i the vertex area.

    Notes
    -----
    After the volumetric graph Laplacian [1]_, with one edge a vertex.

    References
    ----------
    .. [1] Zhou et al., "Large Mesh Deformation Using the Volumetric Graph Laplacian", SIGGRAPH 2005.
    """
    strength = np.broadcast_to(np.asarray(strength, dtype=np.float64), (len(V),))
    if not (strength > 0).any() or len(F) == 0:
        return ExtraEdges.none()
    normals = vertex_normals(V, F)
    partner = _opposite_vertices(V, normals)
    i = np.flatnonzero((partner >= 0) & (strength > 0))
    j = partner[i]
    squared = ((V[i] - V[j]) ** 2).sum(axis=1)
    weights = strength[i] * 4 * vertex_areas(V, F)[i] / squared
    return ExtraEdges(np.column_stack([i, j]), weights)


def shell_edges(V: FloatArray, F: IntArray) -> ExtraEdges:
    """Join the two sides of what is thin, such as cloth with an inside, so that they never cross.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, outward normals.
    F : (m, 3) int
        Faces.

    Returns
    -------
    ExtraEdges
        Between vertices that face each other through less than 1 % of the diagonal, weighted as links;
        none through fingers and toes, which are thin but not broad.
    """
    if len(F) == 0:
        return ExtraEdges.none()
    radius = SHELL * float(np.linalg.norm(np.ptp(V, axis=0)))
    normals = vertex_normals(V, F)
    partner = facing_through(V, normals, radius)
    i = np.flatnonzero(partner >= 0)
    thickness = np.linalg.norm(V[i] - V[partner[i]], axis=1)
    # where vertices lie further apart than the sides do, the next one must be looked at
    reach = np.maximum(2.5 * thickness, 1.5 * np.sqrt(vertex_areas(V, F)[i]))
    i = i[_is_broad(V, normals, i, reach)]
    pairs = np.unique(np.sort(np.column_stack([i, partner[i]]), axis=1), axis=0).reshape(-1, 2)
    return ExtraEdges(pairs, np.full(len(pairs), LINK_WEIGHT))


def _is_broad(V: FloatArray, normals: FloatArray, i: IntArray, reach: FloatArray) -> BoolArray:
    """Tell sheets from fingers: whether the surface goes on all round as far as `reach`."""
    first = np.cross(normals[i], np.eye(3)[np.abs(normals[i]).argmin(axis=1)])
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-30)
    second = np.cross(normals[i], first)
    tree, on = KDTree(V), np.zeros(len(i), dtype=np.int64)
    for angle in np.arange(_LOOKS) * (2 * np.pi / _LOOKS):
        way = np.cos(angle) * first + np.sin(angle) * second
        there = V[i] + reach[:, None] * way
        near = np.asarray(tree.query(there)[1], dtype=np.int64)
        along = np.einsum("sk,sk->s", V[near] - V[i], way)
        alike = np.einsum("sk,sk->s", normals[near], normals[i]) > 0.6
        on += alike & (along > 0.5 * reach)
    return on >= _LOOKS - 1


def _opposite_vertices(V: FloatArray, normals: FloatArray) -> IntArray:
    """Nearest vertex inwards that faces the other way, -1 where there is none.

    Found by marching inwards along the normal in growing steps: the search for all vertices costs a few
    dozen nearest-neighbour queries each, whatever the thickness of the body.
    """
    tree = KDTree(V)
    partner = np.full(len(V), -1, dtype=np.int64)
    open_ = np.flatnonzero(np.linalg.norm(normals, axis=1) > 0.5)
    diagonal = float(np.linalg.norm(np.ptp(V, axis=0)))
    depth = _FIRST_STEP * diagonal
    while len(open_) and depth < diagonal:
        near = _query(tree, V[open_] - depth * normals[open_], min(_NEAR, len(V)))[1]
        distance = np.linalg.norm(V[near] - V[open_][:, None], axis=2)
        found = _faces_opposite(V, normals, open_, near, distance)
        first = np.where(found, distance, np.inf).argmin(axis=1)
        hit = found.any(axis=1)
        partner[open_[hit]] = near[hit, first[hit]]
        open_ = open_[~hit]
        depth *= _GROWTH
    return partner


def _faces_opposite(
    V: FloatArray, normals: FloatArray, i: IntArray, near: IntArray, distance: FloatArray
) -> BoolArray:
    inward = -np.einsum("skc,sc->sk", V[near] - V[i][:, None], normals[i])
    facing = np.einsum("skc,sc->sk", normals[near], normals[i])
    return (inward > 0.9 * distance) & (facing < -0.5) & (distance > 0)
