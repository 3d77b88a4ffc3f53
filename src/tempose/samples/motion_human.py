"""The body of a walking or running human above the legs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import radians

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.rotations import IDENTITY, conjugate, multiply, rotate, slerp
from tempose.samples.motion_arms import ArmAngles, set_arm
from tempose.samples.motion_clip import Body, BodyPose
from tempose.samples.motion_curves import about, wave
from tempose.typing import FloatArray

GRAVITY = 9.81
"""Metres per second squared."""

Path = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Place on the ground (T, 3) and heading (T,) as a function of time; the heading has no jumps."""


@dataclass(frozen=True)
class BodyStyle:
    """How a body moves above its legs, for a leg of one metre; angles in radians, phases of the left leg."""

    lean: float = radians(3)
    """Forward lean of the chest."""
    tilt: float = radians(4)
    """Forward tilt of the pelvis."""
    sway: float = 0.022
    """Sideways over the standing foot, metres."""
    pelvis_yaw: float = radians(5)
    """The hip of the leading leg goes ahead."""
    pelvis_roll: float = radians(3.5)
    """The hip of the swinging leg drops."""
    chest_yaw: float = radians(5)
    """Against the pelvis."""
    arm_swing: float = radians(18)
    """Half the range of the upper arm."""
    arm_offset: float = radians(-6)
    """Mean angle of the upper arm, forward positive."""
    elbow: float = radians(18)
    """Mean bend of the elbow."""
    elbow_swing: float = radians(8)
    """The elbow bends as the arm comes forward."""
    abduction: float = radians(11)
    """Arms away from the body."""
    twist: float = radians(12)
    """Upper arms turned inwards."""
    shrug: float = 0.0
    """Shoulders raised."""


STYLE_FIELDS = (
    "lean",
    "sway",
    "pelvis_yaw",
    "pelvis_roll",
    "chest_yaw",
    "arm_swing",
    "elbow_swing",
    "abduction",
)
"""Amplitudes that differ from one performer to another."""


def human_body(
    skeleton: Skeleton,
    style: BodyStyle,
    path: Path,
    period: float,
    height: float,
    bob: Callable[[FloatArray], FloatArray],
) -> Body:
    """Pelvis, trunk, head and arms in a steady gait along a path.

    Parameters
    ----------
    skeleton : Skeleton
        A human.
    style : BodyStyle
        Amplitudes.
    path : Path
        Where the body goes.
    period : float
        Seconds a stride; the left foot lands at time 0.
    height : float
        Mean height of the root, metres.
    bob : callable
        Height above the mean as a function of phase, metres.

    Returns
    -------
    Body
        Pose as a function of time.
    """

    def body(times: FloatArray) -> BodyPose:
        times = np.asarray(times, dtype=np.float64)
        phase = times / period
        ground, heading = path(times)
        bank, look = _turning(path, times)
        sway = style.sway * wave(phase, 0.31) - height * np.tan(bank)
        shift = np.stack([sway, height + bob(phase), np.zeros_like(phase)], axis=1)
        rotations = np.tile(IDENTITY, (len(times), skeleton.n_joints, 1))
        chest, head = _chest_and_head(style, phase, heading, bank, look)
        set_trunk(skeleton, rotations, _pelvis(style, phase, heading, bank), chest, head)
        for side, offset in (("left", 0.0), ("right", 0.5)):
            set_arm(skeleton, rotations, side, swinging_arm(style, phase + offset))
        return BodyPose(ground + rotate(about("y", heading), shift), rotations, heading)

    return body


def _turning(path: Path, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lean into the curve that balances the centrifugal force, and how far the eyes are ahead of the body."""
    step = 0.05
    (before, yaw0), (after, yaw1) = path(times - step), path(times + step)
    speed = np.linalg.norm(after - before, axis=1) / (2 * step)
    bank = -np.arctan(speed * (yaw1 - yaw0) / (2 * step) / GRAVITY)
    ahead = path(times + 0.35)[1] - path(times)[1]
    return bank, 0.7 * np.tanh(ahead / 0.7)


def _pelvis(style: BodyStyle, phase: FloatArray, heading: FloatArray, bank: FloatArray) -> FloatArray:
    yaw = heading - style.pelvis_yaw * wave(phase, 0.97)
    roll = bank + style.pelvis_roll * wave(phase, 0.17)
    tilt = style.tilt + 0.2 * style.tilt * wave(phase, 0.1, 2)
    return multiply(about("y", yaw), multiply(about("z", roll), about("x", tilt)))


def _chest_and_head(
    style: BodyStyle, phase: FloatArray, heading: FloatArray, bank: FloatArray, look: FloatArray
) -> tuple[FloatArray, FloatArray]:
    yaw = heading + 0.3 * look + style.chest_yaw * wave(phase, 0.97)
    roll = bank - 0.4 * style.pelvis_roll * wave(phase, 0.17)
    lean = style.lean + radians(1) * wave(phase, 0.05, 2)
    chest = multiply(about("y", yaw), multiply(about("z", roll), about("x", lean)))
    nod = 0.25 * style.lean - radians(1) * wave(phase, 0.05, 2)
    head = multiply(about("y", heading + look), multiply(about("x", nod), about("z", 0.4 * bank)))
    return chest, head


def set_trunk(
    skeleton: Skeleton, rotations: FloatArray, pelvis: FloatArray, chest: FloatArray, head: FloatArray
) -> None:
    """Write the local rotations of the trunk; the joints between its parts share the bend.

    Parameters
    ----------
    skeleton : Skeleton
        With ``hips``, ``spine``, ``chest``, ``neck`` and ``head``.
    rotations : (T, J, 4) float
        Local rotations wxyz, changed in place.
    pelvis, chest, head : (T, 4) float
        Rotations in the world, wxyz.
    """
    rotations[:, 0] = pelvis
    for names, base, end in ((("spine", "chest"), pelvis, chest), (("neck", "head"), chest, head)):
        whole = multiply(conjugate(base), end)
        half = slerp(IDENTITY, whole, np.full(len(whole), 0.5))
        rotations[:, skeleton.index(names[0])] = half
        rotations[:, skeleton.index(names[1])] = multiply(conjugate(half), whole)


def swinging_arm(style: BodyStyle, phase: FloatArray) -> ArmAngles:
    """Arm that swings against the leg of its own side.

    Parameters
    ----------
    style : BodyStyle
        Amplitudes.
    phase : (T,) float
        Phase of the leg of the same side, cycles.

    Returns
    -------
    ArmAngles
        T frames; the elbow follows the shoulder late, the wrist later.
    """
    one = np.ones_like(phase)
    return ArmAngles(
        flexion=style.arm_offset + style.arm_swing * wave(phase, 0.5),
        abduction=style.abduction + 0.1 * style.arm_swing * wave(phase, 0.5, 2),
        twist=style.twist * one,
        elbow=style.elbow + style.elbow_swing * wave(phase, 0.54),
        wrist=radians(5) + radians(5) * wave(phase, 0.62),
        shrug=style.shrug + radians(1) * wave(phase, 0.5),
    )


def leg_length(skeleton: Skeleton) -> float:
    """Length of a leg from hip to ground in the rest pose, the unit of every length in a gait.

    Parameters
    ----------
    skeleton : Skeleton
        A human.

    Returns
    -------
    float
        Metres.
    """
    return float(rest_transforms(skeleton)[1][skeleton.index("left_thigh"), 1])
