"""Which faces meet at which edges, and a way to walk from face to face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from tempose.geometry import edge_list
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Hinges:
    """Edges of a mesh and pairs of faces that meet there; side k of a face runs from corner k to k + 1."""

    edges: IntArray
    """(E, 2) int64, lower vertex first, sorted."""
    face_edges: IntArray
    """(m, 3) int64: edge of each side."""
    along: IntArray
    """(m, 3) int64: 1 where the side runs as its edge, from the lower vertex to the higher, -1 against it."""
    faces: IntArray
    """(H, 2) int64: the two faces; where orientations agree the first runs along the edge."""
    sides: IntArray
    """(H, 2) int64: side of each of the two that lies on the edge."""
    edge: IntArray
    """(H,) int64: edge of each hinge."""
    slot: IntArray
    """(H,) int64: place of its angle; the edge's own, further faces of one edge come after all edges."""
    n_slots: int
    """Number of places for angles: E, and one more for each face beyond two at an edge."""
    patches: int
    """Number of sets of faces that hang together by hinges."""
    patch: IntArray
    """(m,) int64: set of each face."""


def find_hinges(F: IntArray) -> Hinges:
    """Find the edges of a mesh and the hinges on them.

    Parameters
    ----------
    F : (m, 3) int
        Faces; none may name a vertex twice.

    Returns
    -------
    Hinges
        An edge of k faces has k - 1 hinges, each between the first of them and another.
    """
    edges = edge_list(F).astype(np.int64)
    start, end = F.astype(np.int64), np.roll(F, -1, axis=1).astype(np.int64)
    base = int(F.max()) + 1
    keys = np.minimum(start, end) * base + np.maximum(start, end)
    face_edges = np.searchsorted(edges[:, 0] * base + edges[:, 1], keys)
    along = np.where(start < end, 1, -1)
    # sides sorted by edge, those that run along it first
    order = np.lexsort((np.arange(face_edges.size), -along.ravel(), face_edges.ravel()))
    edge = face_edges.ravel()[order]
    is_first = np.diff(edge, prepend=-1) != 0
    leader = np.flatnonzero(is_first)[np.cumsum(is_first) - 1]
    other = np.flatnonzero(~is_first)
    pair = np.column_stack([order[leader[other]], order[other]])
    hinge_edge = edge[other]
    extra = np.diff(hinge_edge, prepend=-1) == 0
    slot = np.where(extra, len(edges) + np.cumsum(extra) - 1, hinge_edge)
    faces = pair // 3
    patches, patch = _patches(faces, len(F))
    return Hinges(
        edges,
        face_edges.astype(np.int64),
        along.astype(np.int64),
        faces,
        pair % 3,
        hinge_edge,
        slot,
        len(edges) + int(extra.sum()),
        patches,
        patch,
    )


def _patches(pairs: IntArray, m: int) -> tuple[int, IntArray]:
    graph = sp.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(m, m)).tocsr()
    count, labels = connected_components(graph, directed=False)
    return int(count), labels.astype(np.int64)


def walk(hinges: Hinges, weights: FloatArray) -> tuple[IntArray, IntArray]:
    """Order the faces so that each is reached from an earlier one over the heaviest hinges.

    Parameters
    ----------
    hinges : Hinges
        Of m faces.
    weights : (H,) float
        How well each hinge may be relied on, positive.

    Returns
    -------
    order : (m,) int64
        All faces, patch by patch; the first of each patch is its seed.
    over : (m,) int64
        Hinge over which each of `order` is reached, -1 for a seed.
    """
    m = len(hinges.patch)
    f, g = hinges.faces.T
    by_weight = np.argsort(-weights, kind="stable")
    rank = np.zeros(len(weights))
    rank[by_weight] = np.arange(1, len(weights) + 1)
    # two faces that share two edges: the better hinge stays
    lightest = sp.csr_array((m, m))
    if len(f):
        key = np.minimum(f, g) * m + np.maximum(f, g)
        first = by_weight[np.unique(key[by_weight], return_index=True)[1]]
        lightest = sp.coo_array((rank[first], (f[first], g[first])), shape=(m, m)).tocsr()
    tree = minimum_spanning_tree(lightest)
    hinge_of = sp.coo_array(tree).tocsr()
    both = hinge_of + hinge_of.T
    order, over = [], []
    for seed in np.unique(hinges.patch, return_index=True)[1]:
        reached, before = breadth_first_order(both, seed, directed=False)
        order.append(reached)
        steps = np.full(len(reached), -1)
        if len(reached) > 1:
            ranks = np.asarray(both[reached[1:], before[reached[1:]]]).ravel()
            steps[1:] = by_weight[ranks.astype(np.int64) - 1]
        over.append(steps)
    return np.concatenate(order).astype(np.int64), np.concatenate(over).astype(np.int64)
