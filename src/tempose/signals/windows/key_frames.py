"""Key frames that stand for all poses of a clip."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


def key_frames(X: FloatArray, count: int, first: IntArray | None = None) -> IntArray:
    """Choose frames that stand for a clip: half of them evenly in time, half where poses are far from any.

    Parameters
    ----------
    X : (T, m) float
        Shape coordinates of the frames.
    count : int
        How many; fewer come back where the clip has fewer poses.
    first : (c,) int, optional
        Frames that are chosen in any case.

    Returns
    -------
    (k,) ndarray of int
        Frames, ascending.
    """
    first = np.zeros(0, dtype=np.int64) if first is None else first
    if count >= len(X):
        return np.arange(len(X))
    even = np.linspace(0, len(X) - 1, max(count // 2, 1)).round().astype(np.int64)
    return farthest_frames(X, count, np.union1d(first, even))


def farthest_frames(X: FloatArray, count: int, first: IntArray) -> IntArray:
    """Add frames to some, each the one farthest from all before, so that every frame is near one of them.

    Parameters
    ----------
    X : (T, m) float
        Shape coordinates of the frames.
    count : int
        How many in all; fewer come back where the clip has fewer poses.
    first : (c,) int
        Frames that are chosen already, one or more.

    Returns
    -------
    (k,) ndarray of int
        Frames, ascending.
    """
    chosen = [int(i) for i in first]
    gaps = np.full(len(X), np.inf)
    for i in chosen:
        gaps = np.minimum(gaps, np.square(X - X[i]).sum(axis=1))
    floor = 1e-20 * float(np.square(X - X.mean(axis=0)).sum(axis=1).max())
    while len(chosen) < count and gaps.max() > floor:
        chosen.append(int(gaps.argmax()))
        gaps = np.minimum(gaps, np.square(X - X[chosen[-1]]).sum(axis=1))
    return np.unique(chosen)
