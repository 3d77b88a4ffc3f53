"""Ways along a surface, from piece to piece by the shortest bridges."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from tempose.geometry import edge_list
from tempose.typing import FloatArray, IntArray

_BRIDGE = 2.0  # times the narrowest gap between two pieces: so wide may further bridges beside it be


def surface_links(V: FloatArray, F: IntArray) -> Any:
    """Lengths of the ways between neighbouring vertices, all pieces connected.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces; with none, points are connected by bridges alone.

    Returns
    -------
    (n, n) scipy.sparse.csr_array
        Symmetric; edges, and bridges from every piece to its neighbours in the tree of shortest bridges.

    Notes
    -----
    The tree of bridges leaves two shoes connected through their legs, where every bridge that is short would
    join them to each other. It is Boruvka's: in each round every piece but the largest takes its shortest
    bridge.
    """
    pairs = np.unique(np.sort(edge_list(F), axis=1), axis=0) if len(F) else np.zeros((0, 2), dtype=np.int64)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    count, pieces = connected_components(_links(V, pairs), directed=False)
    groups = pieces
    while count > 1:
        found = _shortest_bridges(V, groups)
        pairs = np.concatenate([pairs, *(_beside(V, pieces, i, j) for i, j in found)])
        count, groups = connected_components(_links(V, pairs), directed=False)
    return _links(V, pairs)


def _links(V: FloatArray, pairs: IntArray) -> Any:
    i, j = np.unique(pairs, axis=0).T
    # two vertices at one place are neighbours too, and a stored zero is no way for the graph routines
    lengths = np.maximum(np.linalg.norm(V[i] - V[j], axis=1), 1e-12)
    entries = (np.r_[lengths, lengths], (np.r_[i, j], np.r_[j, i]))
    return sp.coo_array(entries, shape=(len(V), len(V))).tocsr()


def _shortest_bridges(V: FloatArray, groups: IntArray) -> IntArray:
    """Return (k, 2) vertices: from every group but the largest to the nearest vertex outside it."""
    n, labels = len(V), groups.astype(np.int64)
    near, away = np.zeros(n, dtype=np.int64), np.full(n, np.inf)
    # two groups differ in some bit of their numbers: a few searches serve any number of groups
    for bit in range(int(labels.max()).bit_length()):
        sides = [np.flatnonzero((labels >> bit & 1) == side) for side in (0, 1)]
        for here, there in (sides, sides[::-1]):
            d, k = _nearest(V[there], V[here])
            closer = d < away[here]
            away[here[closer]], near[here[closer]] = d[closer], there[k[closer]]
    order = np.lexsort((away, labels))
    starts = order[np.unique(labels[order], return_index=True)[1]]
    starts = np.delete(starts, np.bincount(labels).argmax())
    return np.column_stack([starts, near[starts]])


def _beside(V: FloatArray, pieces: IntArray, i: int, j: int) -> IntArray:
    """Return the bridge from i to j and those of nearly its length between the same two pieces."""
    here, there = np.flatnonzero(pieces == pieces[i]), np.flatnonzero(pieces == pieces[j])
    reach = _BRIDGE * float(np.linalg.norm(V[i] - V[j]))
    d, k = _nearest(V[there], V[here])
    close = d <= reach
    return np.concatenate([[[i, j]], np.column_stack([here[close], there[k[close]]])])


def _nearest(points: FloatArray, queries: FloatArray) -> tuple[FloatArray, IntArray]:
    d, k = KDTree(points).query(queries)
    return np.asarray(d), np.asarray(k)
