"""Inputs of the learners from a motion."""

from __future__ import annotations

import numpy as np

from tempose.clips import SkeletonClip
from tempose.detail.training import Inputs
from tempose.rotations import conjugate, multiply, to_rotation_vector
from tempose.typing import FloatArray


def motion_inputs(motion: SkeletonClip, fps: float | None = None) -> Inputs:
    """Read a motion as the learners do.

    Parameters
    ----------
    motion : SkeletonClip
        T frames.
    fps : float, optional
        Rate of the training, for which velocities are given; by default that of the motion.

    Returns
    -------
    Inputs
        T frames of one chain.
    """
    rest = motion.skeleton.rest_rotations
    assert rest is not None
    turns = multiply(conjugate(rest), motion.rotations)[:, 1:]
    angles = unwrap(to_rotation_vector(turns))
    velocity = np.diff(angles, axis=0, prepend=angles[:1]) * (motion.fps / (fps or motion.fps))
    if len(angles) > 1:
        velocity[0] = velocity[1]
    none = np.zeros((len(angles), 0))
    return Inputs(angles, velocity, none, np.zeros(len(angles), dtype=np.int64), motion.skeleton.names[1:])


def unwrap(vectors: FloatArray) -> FloatArray:
    """Choose, of the rotation vectors that mean one rotation, the one nearest to the frame before.

    Parameters
    ----------
    vectors : (T, ..., 3) float
        Rotation vectors, radians.

    Returns
    -------
    (T, ..., 3) ndarray
        The same rotations without jumps of 2 pi.
    """
    chosen = np.array(vectors, dtype=np.float64)
    for t in range(1, len(chosen)):
        angle = np.linalg.norm(chosen[t], axis=-1, keepdims=True)
        axis = np.divide(chosen[t], angle, out=np.zeros_like(chosen[t]), where=angle > 1e-9)
        along = (axis * chosen[t - 1]).sum(axis=-1, keepdims=True)
        turns = np.round((along - angle) / (2 * np.pi))
        chosen[t] += 2 * np.pi * turns * axis
    return chosen
