"""Vertices at which surfaces touch that share no edge: lengths and angles say nothing across them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from tempose.typing import FloatArray, IntArray


def split_pinches(F: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Give each surface its own copy of a vertex that several of them share.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    faces : (m, 3) ndarray of int64
        Faces of the mesh with copies; the same where no vertex is shared so.
    source : (n',) ndarray of int64
        Vertex that each one is a copy of, ascending; every vertex is named.
    """
    edges = np.sort(F[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, edge = np.unique(edges, axis=0, return_inverse=True)
    m, k = len(F), int(edge.max()) + 1
    links = coo_matrix((np.ones(3 * m), (np.repeat(np.arange(m), 3), m + edge.ravel())), shape=(m + k, m + k))
    surface = connected_components(links, directed=False)[1][:m]
    loose = np.setdiff1d(np.arange(n), F)
    pairs = np.concatenate(
        [np.stack([F.ravel(), np.repeat(surface, 3)], axis=1), np.stack([loose, 0 * loose], axis=1)]
    )
    copies, number = np.unique(pairs, axis=0, return_inverse=True)
    return number.ravel()[: 3 * m].reshape(-1, 3).astype(np.int64), copies[:, 0].astype(np.int64)


def join_pinches(V: FloatArray, source: IntArray) -> FloatArray:
    """Put copies of a vertex together again.

    Parameters
    ----------
    V : (n', 3) float
        Vertices with copies.
    source : (n',) int
        Of `split_pinches`.

    Returns
    -------
    (n, 3) ndarray
        The mean of the copies of each vertex.
    """
    if source[-1] == len(source) - 1:
        return V
    counts = np.bincount(source)
    return np.stack([np.bincount(source, V[:, i]) / counts for i in range(3)], axis=1)
