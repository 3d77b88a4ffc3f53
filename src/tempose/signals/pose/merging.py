"""Frames whose places in the pose plane are the same but for rounding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from tempose.typing import FloatArray, IntArray

MERGE = 1e-3
"""Places closer than this part of the mean step between frames are one place."""


@dataclass(frozen=True, eq=False)
class Places:
    """Distinct places of the pose plane and what the frames there show on average."""

    group: IntArray
    """(n,) which place a frame is at."""
    first: IntArray
    """(u,) the first frame at every place, ascending."""
    positions: FloatArray
    """(u, 2) mean position."""
    values: FloatArray
    """(u, m) mean of the frames' coordinates, by weight."""
    weights: FloatArray
    """(u,) sum of the frames' weights."""
    floor: float
    """Squared distance of all frames to those means, by weight: what no spline can undercut."""


def merge_places(P: FloatArray, X: FloatArray, weights: FloatArray | None = None) -> Places:
    """Merge frames at one place.

    Parameters
    ----------
    P : (n, 2) float
        Places of frames, in order of time.
    X : (n, m) float
        Shape coordinates.
    weights : (n,) float, optional
        How much the squared error of each frame counts; 1 if left out.

    Returns
    -------
    Places
        A frame joins the first place that lies within `MERGE` of the mean step.
    """
    weights = np.ones(len(P)) if weights is None else weights
    group = _groups(P)
    first = np.unique(group, return_index=True)[1]
    if len(first) == len(P):
        return Places(group, first, P, X, weights, 0.0)
    total = np.bincount(group, weights).astype(np.float64)

    def mean(A: FloatArray) -> FloatArray:
        sums = np.zeros((len(first), A.shape[1]))
        np.add.at(sums, group, A * weights[:, None])
        return sums / total[:, None]

    values = mean(X)
    floor = float((np.square(X - values[group]) * weights[:, None]).sum())
    return Places(group, first, mean(P), values, total, floor)


def _groups(P: FloatArray) -> IntArray:
    steps = np.linalg.norm(np.diff(P, axis=0), axis=1)
    near = MERGE * float(steps.mean()) if len(steps) else 0.0
    leader = np.arange(len(P))
    pairs = KDTree(P).query_pairs(near, output_type="ndarray")
    # in order of the later frame and then of the earlier, so that the earliest place near it wins
    for i, j in pairs[np.lexsort((pairs[:, 0], pairs[:, 1]))]:
        if leader[j] == j and leader[i] == i:
            leader[j] = i
    return np.unique(leader, return_inverse=True)[1].reshape(-1)
