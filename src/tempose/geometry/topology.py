"""Who is beside whom."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.typing import FloatArray, IntArray


def edge_list(F: IntArray) -> IntArray:
    """Undirected edges, each once.

    Parameters
    ----------
    F : (m, 3) int
        Faces.

    Returns
    -------
    (e, 2) ndarray of int
        Lower index first, sorted; a face that names a vertex twice gives no edge from it to itself.
    """
    key, base = _edge_keys(F)
    ordered = np.sort(key[key % (base + 1) != 0])
    unique = ordered[np.diff(ordered, prepend=-1) != 0]
    return np.column_stack([unique // base, unique % base]).astype(F.dtype)


def boundary_edges(F: IntArray) -> IntArray:
    """Directed edges that only one face has.

    Parameters
    ----------
    F : (m, 3) int
        Faces.

    Returns
    -------
    (b, 2) ndarray of int
        In the direction of their face.
    """
    key, base = _edge_keys(F)
    _, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    alone = (count[inverse.ravel()] == 1) & (key % (base + 1) != 0)
    return np.column_stack([F.T.ravel(), np.roll(F, -1, axis=1).T.ravel()])[alone]


def _edge_keys(F: IntArray) -> tuple[IntArray, int]:
    """One number for each of the 3 m edges, the same in both directions: sorting numbers beats sorting rows.

    The key is ``low * base + high``; an edge from a vertex to itself is a multiple of ``base + 1``.
    """
    base = int(F.max(initial=0)) + 1
    a, b = F.T.ravel().astype(np.int64), np.roll(F, -1, axis=1).T.ravel().astype(np.int64)
    return np.minimum(a, b) * base + np.maximum(a, b), base


def vertex_adjacency(F: IntArray, n: int) -> Any:
    """Symmetric 0-1 matrix of vertices joined by an edge.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    (n, n) scipy.sparse.csr_array of int32
        Without diagonal.
    """
    i, j = edge_list(F).T if len(F) else np.zeros((2, 0), dtype=int)
    ones = np.ones(2 * len(i), dtype=np.int32)
    return sp.coo_array((ones, (np.r_[i, j], np.r_[j, i])), shape=(n, n)).tocsr()


def vertex_components(F: IntArray, n: int) -> tuple[int, IntArray]:
    """Find connected components over edges; a vertex without a face is one of its own.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    count : int
        Number of components.
    labels : (n,) ndarray of int
        Component of every vertex.
    """
    count, labels = connected_components(vertex_adjacency(F, n), directed=False)
    return int(count), labels


def face_components(F: IntArray, n: int) -> tuple[int, IntArray]:
    """Components that hold at least one face, numbered from 0.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    count : int
        Number of components.
    labels : (m,) ndarray of int
        Component of every face.
    """
    _, labels = vertex_components(F, n)
    used, of_face = np.unique(labels[F[:, 0]], return_inverse=True)
    return len(used), of_face.ravel()


def k_rings(F: IntArray, n: int, seeds: IntArray, k: int) -> list[IntArray]:
    """Vertices within k edges of each seed, the seed included.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    seeds : (s,) int
        Vertices.
    k : int
        Number of edges.

    Returns
    -------
    list of (r,) ndarray of int
        Sorted vertex indices, one array a seed.
    """
    identity: Any = sp.diags_array(np.ones(n)).tocsr()
    step = vertex_adjacency(F, n) + identity
    reach = identity[np.asarray(seeds)]
    for _ in range(k):
        reach = (reach @ step).sign()
    reach = reach.tocsr()
    reach.sort_indices()
    return [reach.indices[reach.indptr[s] : reach.indptr[s + 1]] for s in range(len(seeds))]


def weld(V: FloatArray) -> tuple[IntArray, IntArray]:
    """Find vertices at exactly equal positions, as UV seams leave them.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.

    Returns
    -------
    first : (u,) ndarray of int
        First vertex at each distinct position, ascending.
    inverse : (n,) ndarray of int
        Which of them each vertex equals: ``V[first][inverse] == V``.
    """
    # + 0.0 turns -0.0 into 0.0, which are equal but differ in their bytes
    rows = np.ascontiguousarray(V + 0.0).view([("", V.dtype)] * V.shape[1]).ravel()
    _, first, inverse = np.unique(rows, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.zeros(len(first), dtype=np.int64)
    rank[order] = np.arange(len(first))
    return first[order], rank[inverse.ravel()]
