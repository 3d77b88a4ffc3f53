"""A human on the spot whose pose runs through a few keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.rotations import IDENTITY
from tempose.samples.motion_arms import ArmAngles, set_arm
from tempose.samples.motion_clip import Body, BodyPose
from tempose.samples.motion_curves import about
from tempose.samples.motion_human import leg_length, set_trunk
from tempose.samples.motion_limbs import human_leg, limb_vector
from tempose.typing import FloatArray

Curve = Callable[[FloatArray], FloatArray]
"""A number as a function of time in seconds."""

ARM = ("flexion", "abduction", "twist", "elbow", "wrist", "shrug")


@dataclass(frozen=True, eq=False)
class Keyed:
    """Angles of trunk and arms as functions of time, radians."""

    tilt: Curve
    """Pelvis forward."""
    lean: Curve
    """Chest forward."""
    nod: Curve
    """Head forward."""
    arms: Mapping[str, Mapping[str, Curve]]
    """For ``"left"`` and ``"right"``, each field of `ArmAngles`."""


def keyed(times: FloatArray, degrees: tuple[float, ...]) -> Curve:
    """Smooth curve through keys, still before the first and after the last.

    Parameters
    ----------
    times : (k,) float
        Seconds.
    degrees : tuple of float
        k angles.

    Returns
    -------
    callable
        Radians as a function of time.
    """
    spline = CubicSpline(times, np.radians(degrees), bc_type="clamped")
    return lambda t: spline(np.clip(t, times[0], times[-1]))


def constant(degrees: float) -> Curve:
    """Curve that does not move.

    Parameters
    ----------
    degrees : float
        The angle.

    Returns
    -------
    callable
        Radians as a function of time.
    """
    return lambda t: np.full(len(t), np.radians(degrees))


def keyed_body(skeleton: Skeleton, pose: Keyed, place: Callable[[FloatArray], FloatArray]) -> Body:
    """Body that faces +Z and follows its keys.

    Parameters
    ----------
    skeleton : Skeleton
        A human.
    pose : Keyed
        Angles.
    place : callable
        Position (T, 3) of the root as a function of time, metres.

    Returns
    -------
    Body
        Pose as a function of time.
    """

    def body(times: FloatArray) -> BodyPose:
        rotations = np.tile(IDENTITY, (len(times), skeleton.n_joints, 1))
        pelvis, chest, head = (about("x", curve(times)) for curve in (pose.tilt, pose.lean, pose.nod))
        set_trunk(skeleton, rotations, pelvis, chest, head)
        for side, arm in pose.arms.items():
            set_arm(skeleton, rotations, side, ArmAngles(**{name: arm[name](times) for name in ARM}))
        return BodyPose(place(times), rotations, np.zeros(len(times)))

    return body


def standing_height(skeleton: Skeleton, width: float, flexion: float) -> float:
    """Height of the root of a human who stands upright.

    Parameters
    ----------
    skeleton : Skeleton
        A human.
    width : float
        Distance of each foot from the middle line, metres.
    flexion : float
        Bend of the knees, radians.

    Returns
    -------
    float
        Metres.
    """
    limb = human_leg(skeleton, "left")
    zero = np.zeros(1)
    length = float(np.linalg.norm(limb_vector(limb, zero + flexion, zero, zero)))
    positions = rest_transforms(skeleton)[1]
    ankle, hip = positions[limb.joints[-1]], positions[limb.joints[0]]
    spread = np.hypot(width - hip[0], ankle[2] - hip[2])
    return float(ankle[1] + np.sqrt(length**2 - spread**2) + positions[0, 1] - hip[1])


def stance_width(skeleton: Skeleton) -> float:
    """Distance of each foot from the middle line when standing at ease.

    Parameters
    ----------
    skeleton : Skeleton
        A human.

    Returns
    -------
    float
        Metres.
    """
    return 0.11 * leg_length(skeleton)
