"""A rotation split into a turn about an axis and what tilts that axis."""

from __future__ import annotations

import numpy as np

from tempose.rotations.quaternions import conjugate, multiply, normalise
from tempose.typing import FloatArray


def swing_twist(q: FloatArray, axis: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Split rotations so that ``q = swing * twist`` with the twist about `axis`.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.
    axis : (..., 3) float
        Unit vectors.

    Returns
    -------
    swing : (..., 4) ndarray
        Rotation whose axis is perpendicular to `axis`.
    twist : (..., 4) ndarray
        Rotation about `axis`; the identity where the split is undefined (a half turn of the axis itself).
    """
    q = np.asarray(q, dtype=np.float64)
    along = np.sum(q[..., 1:] * axis, axis=-1, keepdims=True)
    twist = normalise(np.concatenate([q[..., :1], along * axis], axis=-1))
    return multiply(q, conjugate(twist)), twist
