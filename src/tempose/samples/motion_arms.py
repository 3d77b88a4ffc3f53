"""Arms of a human, by the angles an anatomist would name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton
from tempose.rotations import conjugate, from_rotation_vector, multiply, rotate, shortest_rotation
from tempose.samples.motion_curves import about
from tempose.typing import FloatArray

DOWN = np.array([0.0, -1.0, 0.0])


@dataclass(frozen=True, eq=False)
class ArmAngles:
    """Radians per frame, zero for an arm that hangs straight down with the palm at the thigh."""

    flexion: FloatArray
    """(T,) forward."""
    abduction: FloatArray
    """(T,) away from the body."""
    twist: FloatArray
    """(T,) of the upper arm inwards."""
    elbow: FloatArray
    """(T,) bend from straight."""
    wrist: FloatArray
    """(T,) bend of the hand towards the palm."""
    shrug: FloatArray
    """(T,) rise of the shoulder."""


def set_arm(skeleton: Skeleton, rotations: FloatArray, side: str, arm: ArmAngles) -> None:
    """Write the local rotations of an arm.

    Parameters
    ----------
    skeleton : Skeleton
        With ``clavicle``, ``upper_arm``, ``forearm`` and ``hand`` of that side; any rest pose of the arm.
    rotations : (T, J, 4) float
        Local rotations wxyz, changed in place.
    side : str
        ``"left"`` or ``"right"``.
    arm : ArmAngles
        T frames.
    """
    sign = 1.0 if side == "left" else -1.0
    clavicle, upper, forearm, hand = (
        skeleton.index(f"{side}_{name}") for name in ("clavicle", "upper_arm", "forearm", "hand")
    )
    bone, lower = skeleton.offsets[forearm], skeleton.offsets[hand]
    hang = shortest_rotation(bone, DOWN)
    reach = multiply(about("y", -sign * 0.12 * arm.flexion), about("z", sign * arm.shrug))
    swing = multiply(about("x", -arm.flexion), about("z", sign * arm.abduction))
    whole = multiply(multiply(swing, about("y", -sign * arm.twist)), hang)
    rotations[:, clavicle] = reach
    rotations[:, upper] = multiply(conjugate(reach), whole)
    hinge = rotate(conjugate(hang), np.array([-1.0, 0.0, 0.0]))
    rotations[:, forearm] = from_rotation_vector((arm.elbow - _rest_bend(bone, lower))[:, None] * hinge)
    rotations[:, hand] = from_rotation_vector(arm.wrist[:, None] * sign * _palm_axis(lower))


def _rest_bend(upper: FloatArray, lower: FloatArray) -> float:
    cosine = upper @ lower / (np.linalg.norm(upper) * np.linalg.norm(lower))
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _palm_axis(lower: FloatArray) -> FloatArray:
    """Axis across the wrist, forwards, so that a turn about it moves the fingers of the left hand inwards."""
    along = lower / np.linalg.norm(lower)
    axis = np.array([0.0, 0.0, -1.0]) + along[2] * along
    return axis / np.linalg.norm(axis)
