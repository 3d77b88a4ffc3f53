"""Which way a body faces, and the turn about the vertical that makes two face alike."""

from __future__ import annotations

import numpy as np

from tempose.rotations import from_rotation_vector
from tempose.transfer.bodies.bones import Bones
from tempose.typing import FloatArray

UP: FloatArray = np.array([0.0, 1.0, 0.0])
_SIDES = ("thigh", "upper_arm", "clavicle", "shin", "forearm")


def yaw(angle: FloatArray | float) -> FloatArray:
    """Rotation about the vertical.

    Parameters
    ----------
    angle : (...) float
        Radians, from +Z towards +X.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz.
    """
    return from_rotation_vector(np.asarray(angle, dtype=np.float64)[..., None] * UP)


def heading(direction: FloatArray) -> FloatArray:
    """Angle of the horizontal part of a direction.

    Parameters
    ----------
    direction : (..., 3) float
        Directions.

    Returns
    -------
    (...) ndarray
        Radians, 0 for +Z, towards +X.
    """
    return np.arctan2(direction[..., 0], direction[..., 2])


def lateral(bones: Bones, starts: FloatArray) -> FloatArray | None:
    """Vector from the right side of the body to the left.

    Parameters
    ----------
    bones : Bones
        With roles.
    starts : (..., B, 3) float
        Bone starts.

    Returns
    -------
    (..., 3) ndarray or None
        Not normalised; None where no paired limbs are known.
    """
    for part in _SIDES:
        left, right = bones.find("left_" + part), bones.find("right_" + part)
        if left is not None and right is not None:
            return starts[..., left, :] - starts[..., right, :]
    return None


def yaw_between(bones: Bones, source: FloatArray, target: FloatArray) -> FloatArray:
    """Turn about the vertical that makes the target face as the source does.

    Parameters
    ----------
    bones : Bones
        The bones of both.
    source, target : (..., B, 3), (B, 3) float
        Bone starts.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz, by the line of the hips, or by the best fit of all joints seen from above.
    """
    a, b = lateral(bones, source), lateral(bones, target)
    if a is not None and b is not None:
        return yaw(heading(a) - heading(b))
    p = source - source.mean(axis=-2, keepdims=True)
    q = target - target.mean(axis=-2, keepdims=True)
    sine = (p[..., 0] * q[..., 2] - p[..., 2] * q[..., 0]).sum(axis=-1)
    cosine = (p[..., 0] * q[..., 0] + p[..., 2] * q[..., 2]).sum(axis=-1)
    return yaw(np.arctan2(sine, cosine))
