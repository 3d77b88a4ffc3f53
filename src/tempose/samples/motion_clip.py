"""Motions that know where they touch the ground."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tempose.clips import SkeletonClip
from tempose.kinematics import forward_kinematics
from tempose.rotations import rotate
from tempose.typing import BoolArray, FloatArray


@dataclass(frozen=True)
class SolePoint:
    """A point of a foot that touches the ground."""

    name: str
    """Joint and part of the foot, such as ``"left_foot_heel"``."""
    joint: int
    """Joint that carries it."""
    offset: tuple[float, float, float]
    """Metres, in the basis of that joint."""


@dataclass(frozen=True, eq=False)
class SampleMotion(SkeletonClip):
    """A skeleton clip together with the truth about its contacts: the ground is the plane of height zero."""

    soles: tuple[SolePoint, ...] = ()
    """S points of the feet."""
    contacts: BoolArray = field(default_factory=lambda: np.zeros((0, 0), dtype=bool))
    """(T, S) True where a point stands on the ground: it does not move between two such frames."""


@dataclass(frozen=True, eq=False)
class BodyPose:
    """Everything but the legs, at some times."""

    root_position: FloatArray
    """(T, 3) metres."""
    rotations: FloatArray
    """(T, J, 4) local rotations wxyz; those of the legs are still to be found."""
    heading: FloatArray
    """(T,) radians about Y, 0 along +Z, positive to the left; without jumps by 2 pi."""


Body = Callable[[FloatArray], BodyPose]
"""Pose of a body without its legs as a function of time (T,) in seconds."""


def sole_positions(motion: SampleMotion) -> FloatArray:
    """World positions of the points that touch the ground.

    Parameters
    ----------
    motion : SampleMotion
        T frames with S sole points.

    Returns
    -------
    (T, S, 3) ndarray
        Metres.
    """
    world, positions = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)
    joints = [sole.joint for sole in motion.soles]
    offsets = np.array([sole.offset for sole in motion.soles])
    return positions[:, joints] + rotate(world[:, joints], offsets)
