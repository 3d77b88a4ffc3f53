"""Inputs of the learners from a motion."""

from __future__ import annotations

import numpy as np

from tempose.clips import SkeletonClip
from tempose.detail.training import Inputs
from tempose.rotations import conjugate, multiply, slerp, to_rotation_vector
from tempose.typing import FloatArray

_SNAP = 1e-6
"""Part of a frame below which a moment counts as the frame itself."""


def motion_inputs(
    motion: SkeletonClip, fps: float | None = None, near: FloatArray | None = None, chain: int = 0
) -> Inputs:
    """Read a motion as the learners do.

    Parameters
    ----------
    motion : SkeletonClip
        T frames.
    fps : float, optional
        Rate of the training, for which velocities are given; by default that of the motion.
    near : (K, 3) float, optional
        Of the rotation vectors that mean the rotations of the first frame those nearest to these are taken:
        the mean of the training, so that one pose has one name in all clips.
    chain : int, default 0
        Number of the clip.

    Returns
    -------
    Inputs
        T frames of one chain.
    """
    rest = motion.skeleton.rest_rotations
    assert rest is not None
    turns = multiply(conjugate(rest), motion.rotations)[:, 1:]
    angles = unwrap(to_rotation_vector(turns), near)
    velocity = _velocity(turns, angles, motion.fps / (fps or motion.fps))
    T, names = len(angles), motion.skeleton.names[1:]
    chains = np.full(T, chain, dtype=np.int64)
    return Inputs(angles, velocity, np.zeros((T, 0)), chains, names, fps or motion.fps)


def joined_inputs(chains: list[Inputs]) -> Inputs:
    """Put clips one after another.

    Parameters
    ----------
    chains : list of Inputs
        Of the same joints and rate; at least one.

    Returns
    -------
    Inputs
        Every clip a chain of its own.
    """
    return Inputs(
        np.concatenate([c.angles for c in chains]),
        np.concatenate([c.velocity for c in chains]),
        np.concatenate([c.extra for c in chains]),
        np.repeat(np.arange(len(chains)), [len(c) for c in chains]),
        chains[0].joints,
        chains[0].fps,
    )


def unwrap(vectors: FloatArray, near: FloatArray | None = None) -> FloatArray:
    """Choose, of the rotation vectors that mean one rotation, the one nearest to the frame before.

    Parameters
    ----------
    vectors : (T, ..., 3) float
        Rotation vectors, radians.
    near : (..., 3) float, optional
        What the first frame is to be nearest to; it stays as it is where left out.

    Returns
    -------
    (T, ..., 3) ndarray
        The same rotations without jumps of 2 pi.
    """
    chosen = np.array(vectors, dtype=np.float64)
    if near is not None and len(chosen):
        chosen[0] = nearest_turn(chosen[0], near)
    for t in range(1, len(chosen)):
        chosen[t] = nearest_turn(chosen[t], chosen[t - 1])
    return chosen


def nearest_turn(vectors: FloatArray, near: FloatArray) -> FloatArray:
    """Add whole turns to rotation vectors until they are nearest to others.

    Parameters
    ----------
    vectors : (..., 3) float
        Rotation vectors, radians.
    near : (..., 3) float
        Others.

    Returns
    -------
    (..., 3) ndarray
        The same rotations.
    """
    angle = np.linalg.norm(vectors, axis=-1, keepdims=True)
    # no turn has no axis: any will do, so the one that is wanted
    length = np.linalg.norm(near, axis=-1, keepdims=True)
    wanted = np.divide(near, length, out=np.zeros_like(near), where=length > 0)
    axis = np.divide(vectors, angle, out=np.array(wanted + 0 * vectors), where=angle > 1e-9)
    along = (axis * near).sum(axis=-1, keepdims=True)
    return vectors + 2 * np.pi * np.round((along - angle) / (2 * np.pi)) * axis


def _velocity(turns: FloatArray, angles: FloatArray, step: float) -> FloatArray:
    """Change of the angles since `step` frames before; the first frames move as the first that knows."""
    T = len(angles)
    if T == 1:
        return np.zeros_like(angles)
    reach = min(step, float(T - 1))
    first = int(np.ceil(reach - _SNAP))
    place = np.maximum(np.arange(first, T) - reach, 0.0)
    before = np.floor(place + _SNAP).astype(np.int64)
    part = np.maximum(place - before, 0.0)
    after = np.minimum(before + 1, T - 1)
    between = slerp(turns[before], turns[after], part[:, None])
    earlier = np.where(
        (part < _SNAP)[:, None, None],
        angles[before],
        nearest_turn(to_rotation_vector(between), angles[before]),
    )
    velocity = np.zeros_like(angles)
    velocity[first:] = (angles[first:] - earlier) * (step / reach)
    velocity[:first] = velocity[first]
    return velocity
