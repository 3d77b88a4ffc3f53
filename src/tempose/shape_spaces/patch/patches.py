"""A surface cut into patches of about the same size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, dijkstra, minimum_spanning_tree

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Patches:
    """Faces grouped, and which groups are beside each other; through some neighbours any reaches any."""

    of_face: IntArray
    """(m,) patch of every face, from 0."""
    pairs: IntArray
    """(e, 2) neighbours, lower index first."""
    shares: FloatArray
    """(p,) share of each in the area; sums to 1."""
    pair_weights: FloatArray
    """(e,) positive; sums to 1 (none: one patch)."""


def make_patches(V: FloatArray, F: IntArray, shares: FloatArray, count: int) -> Patches:
    """Cut a surface into patches round faces far from each other.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    shares : (m,) float
        Share of each in the area.
    count : int
        Number of patches at most; fewer where there are fewer faces.

    Returns
    -------
    Patches
        Connected over shared edges; pieces that do not touch count as neighbours of near pieces.
    """
    centres = V[F].mean(axis=1)
    graph = _face_graph(centres, F)
    seeds = _far_seeds(centres, shares, min(count, len(F)))
    _, _, nearest = dijkstra(graph, directed=False, indices=seeds, return_predecessors=True, min_only=True)
    _, of_face = np.unique(nearest, return_inverse=True)
    coo = graph.tocoo()
    across = np.sort(np.stack([of_face[coo.row], of_face[coo.col]], axis=1), axis=1)
    pairs = np.unique(across[across[:, 0] != across[:, 1]], axis=0).reshape(-1, 2)
    return weighed_patches(of_face, pairs, shares)


def weighed_patches(of_face: IntArray, pairs: IntArray, shares: FloatArray) -> Patches:
    """Weigh patches by their areas, and pairs of neighbours by those of both.

    Parameters
    ----------
    of_face : (m,) int
        Patch of every face.
    pairs : (e, 2) int
        Neighbours.
    shares : (m,) float
        Share of each face in the area.

    Returns
    -------
    Patches
        With weights.
    """
    of_patch = np.bincount(of_face, shares).astype(np.float64)
    spread = of_patch / np.maximum(np.bincount(pairs.ravel(), minlength=len(of_patch)), 1)
    weights = spread[pairs].mean(axis=1)
    return Patches(of_face, pairs, of_patch, weights / weights.sum() if len(pairs) else weights)


def _face_graph(centres: FloatArray, F: IntArray) -> Any:
    """Distances between faces that share an edge, and links between pieces."""
    m = len(F)
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1).astype(np.int64)
    key = edges[:, 0] * (int(F.max()) + 1) + edges[:, 1]
    order = np.argsort(key, kind="stable")
    same = key[order[1:]] == key[order[:-1]]
    pairs = np.stack([order[:-1][same] % m, order[1:][same] % m], axis=1)
    pairs = np.concatenate([pairs[pairs[:, 0] != pairs[:, 1]], _links(centres, pairs, m)])
    length = np.linalg.norm(centres[pairs[:, 0]] - centres[pairs[:, 1]], axis=1)
    # a distance of zero would be no edge at all
    length = np.maximum(length, 1e-9 * length.max(initial=1e-300))
    pairs, first = np.unique(np.sort(pairs, axis=1), axis=0, return_index=True)
    return sp.coo_array((length[first], (pairs[:, 0], pairs[:, 1])), shape=(m, m)).tocsr()


def _links(centres: FloatArray, pairs: IntArray, m: int) -> IntArray:
    """Pairs of faces that join the pieces into one, between pieces whose middles are near."""
    ones = np.ones(len(pairs))
    count, piece = connected_components(sp.coo_array((ones, (pairs[:, 0], pairs[:, 1])), shape=(m, m)))
    if count == 1:
        return np.zeros((0, 2), dtype=np.int64)
    size = np.bincount(piece)
    middles = np.stack([np.bincount(piece, centres[:, c]) / size for c in range(3)], axis=1)
    apart = np.linalg.norm(middles[:, None] - middles[None], axis=2)
    apart += 1e-9 * max(apart.max(), 1e-300)
    tree = minimum_spanning_tree(np.triu(apart, 1)).tocoo()
    faces = np.arange(m)
    found: list[tuple[int, int]] = []
    for a, b in zip(tree.row, tree.col):
        in_a, in_b = faces[piece == a], faces[piece == b]
        i = in_a[np.linalg.norm(centres[in_a] - middles[b], axis=1).argmin()]
        j = in_b[np.linalg.norm(centres[in_b] - centres[i], axis=1).argmin()]
        found.append((int(i), int(j)))
    return np.array(found, dtype=np.int64)


def _far_seeds(centres: FloatArray, shares: FloatArray, count: int) -> IntArray:
    """Faces far from each other; the first is the one farthest from the middle."""
    middle = shares @ centres
    seeds = [int(((centres - middle) ** 2).sum(axis=1).argmax())]
    distance = ((centres - centres[seeds[0]]) ** 2).sum(axis=1)
    while len(seeds) < count and distance.max() > 0:
        seeds.append(int(distance.argmax()))
        distance = np.minimum(distance, ((centres - centres[seeds[-1]]) ** 2).sum(axis=1))
    return np.array(seeds)
