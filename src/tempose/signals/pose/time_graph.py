"""Distances between frames along their motion, where straight ones mislead."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import shortest_path

from tempose.typing import FloatArray


def time_graph_distances(distances: FloatArray, reach: FloatArray | float) -> FloatArray:
    """Return the lengths of shortest paths over frames that follow or nearly equal one another.

    Parameters
    ----------
    distances : (n, n) float
        Distances between the poses of all frames.
    reach : float or (n,) float
        Frames i and j are joined when their distance is at most ``min(reach_i step_i, reach_j step_j)``,
        with the smaller step beside each; neighbours in time always are. Infinite: all are joined.

    Returns
    -------
    (n, n) ndarray
        Symmetric. Large reach gives `distances`, reach 0 the length of the motion between frames.
    """
    n = len(distances)
    if n < 3:
        return distances.copy()
    steps = np.diagonal(distances, 1)
    beside = np.minimum(np.r_[steps[0], steps], np.r_[steps, steps[-1]])
    # a still frame beside a moving one reaches as far as the motion does
    beside = np.maximum(beside, 0.1 * float(steps.mean()))
    far = np.full(n, np.inf) if np.isscalar(reach) and np.isinf(float(np.max(reach))) else beside * reach
    joined = distances <= np.minimum(far[:, None], far[None])
    i = np.arange(n - 1)
    joined[i, i + 1] = joined[i + 1, i] = True
    if joined.all():
        return distances.copy()
    # csgraph reads a zero as no edge: frames that repeat exactly need a length of their own
    rows, columns = np.nonzero(joined)
    lengths = np.maximum(distances[rows, columns], 1e-12 * distances.max())
    lengths[rows == columns] = 0.0
    graph = csr_array((lengths, (rows, columns)), shape=(n, n))
    graph.eliminate_zeros()
    return np.asarray(shortest_path(graph, directed=False))
