"""At most a few joints a vertex, as engines want it."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


def strongest(weights: FloatArray, most: int = 4) -> tuple[IntArray, FloatArray]:
    """Keep the largest weights of every vertex.

    Parameters
    ----------
    weights : (n, J) float
        Rows >= 0.
    most : int, default 4
        How many to keep.

    Returns
    -------
    joints : (n, most) ndarray of int
        Joints, heaviest first; 0 where there are fewer.
    kept : (n, most) ndarray
        Their weights, rows summing to what they summed to before.

    Examples
    --------
    >>> joints, kept = strongest(np.array([[0.5, 0.1, 0.4]]), 2)
    >>> joints.tolist(), kept.round(3).tolist()
    ([[0, 2]], [[0.556, 0.444]])
    """
    n, J = weights.shape
    if most > J:
        weights = np.concatenate([weights, np.zeros((n, most - J))], axis=1)
    # a stable sort, so that equal weights are kept in the order of the joints
    joints = np.argsort(-weights, axis=1, kind="stable")[:, :most]
    kept = np.take_along_axis(weights, joints, axis=1)
    sums = kept.sum(axis=1, keepdims=True)
    kept = kept * np.divide(weights.sum(axis=1, keepdims=True), sums, out=np.ones_like(sums), where=sums > 0)
    return np.where(kept > 0, joints, 0), kept
