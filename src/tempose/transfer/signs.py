"""Of q and -q the one that interpolates well with its neighbours."""

from __future__ import annotations

import numpy as np

from tempose.rotations import conjugate, multiply
from tempose.typing import FloatArray, IntArray


def consistent_signs(Q: FloatArray, parents: IntArray) -> FloatArray:
    """Choose signs along a tree of bones, continuous in time.

    Parameters
    ----------
    Q : (T, B, 4) float
        Unit quaternions wxyz in the world.
    parents : (B,) int
        Tree, parents first; -1 at roots, which hang on bone 0.

    Returns
    -------
    (T, B, 4) ndarray
        The same rotations. In frame 0 each bone lies within a half turn of its parent; later the rotation
        relative to the parent is continuous, so that a limb that turns past 180 degrees shows no jump.

    Notes
    -----
    The rule is applied to relative rotations: absolute continuity in time contradicts agreement with the
    parent once a limb has turned further than a half turn against it.
    """
    Q = np.array(Q, dtype=np.float64)
    for b in range(1, Q.shape[1]):
        p = max(int(parents[b]), 0)
        relative = multiply(conjugate(Q[:, p]), Q[:, b])
        steps = np.sum(relative[1:] * relative[:-1], axis=-1)
        start = 1.0 if relative[0, 0] >= 0 else -1.0
        sign = start * np.cumprod(np.r_[1.0, np.where(steps < 0, -1.0, 1.0)])
        Q[:, b] = multiply(Q[:, p], relative * sign[:, None])
    return Q
