"""Legs that hang from a body, and how high the body can be carried by them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import forward_kinematics
from tempose.samples.motion_clip import Body, BodyPose
from tempose.samples.motion_feet import Foot
from tempose.samples.motion_limbs import Limb, limb_vector
from tempose.samples.motion_stances import STATE, Stance, planted
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Leg:
    """A limb, its foot, and when and where it stands."""

    limb: Limb
    """Bones from the body to the foot."""
    foot: Foot
    """The foot at its end."""
    stances: Sequence[Stance]
    """In order of time; the first starts before the clip, the last ends after it."""
    via: FloatArray = field(default_factory=lambda: np.zeros((0, len(STATE))))
    """(k, 8) state to pass through in every swing; NaN leaves a curve free."""
    at: FloatArray = field(default_factory=lambda: np.zeros(0))
    """(k,) where in the swing, between 0 and 1."""

    @property
    def clearance(self) -> float:
        """Height of the sole in the middle of a swing that would otherwise graze the ground, metres."""
        return 0.015 * float(np.linalg.norm(self.limb.bones, axis=1).sum())


def swing_keys(via: Sequence[Mapping[str, float]]) -> tuple[FloatArray, FloatArray]:
    """Arrange the states that a swing passes through.

    Parameters
    ----------
    via : sequence of mapping
        Each with ``at``, the part of the swing gone by, and some of the angles in `STATE`.

    Returns
    -------
    via : (k, 8) ndarray
        Radians, NaN where nothing was given.
    at : (k,) ndarray
        Parts of the swing.
    """
    rows = [[key.get(name, np.nan) for name in STATE] for key in via]
    return np.array(rows).reshape(-1, len(STATE)), np.array([key["at"] for key in via])


def limb_roots(skeleton: Skeleton, limb: Limb, pose: BodyPose) -> tuple[FloatArray, FloatArray]:
    """World rotation of the bone that carries a limb, and place of the limb's first joint.

    Parameters
    ----------
    skeleton : Skeleton
        The joints.
    limb : Limb
        One of its limbs.
    pose : BodyPose
        T poses.

    Returns
    -------
    rotation : (T, 4) ndarray
        Quaternions wxyz.
    position : (T, 3) ndarray
        Metres.
    """
    world, positions = forward_kinematics(skeleton, pose.rotations, pose.root_position)
    first = limb.joints[0]
    return world[:, skeleton.parents[first]], positions[:, first]


def headroom(skeleton: Skeleton, body: Body, legs: Sequence[Leg], flexion: float) -> float:
    """Height by which a body can rise before a standing leg is stretched too far.

    Parameters
    ----------
    skeleton : Skeleton
        The joints.
    body : Body
        What the legs hang from.
    legs : sequence of Leg
        The legs.
    flexion : float
        The least that a standing leg may be bent, radians.

    Returns
    -------
    float
        Metres; negative when the body is too high already.
    """
    room: list[float] = []
    for leg in legs:
        moments = [(stance, np.linspace(stance.start, stance.end, 40)) for stance in leg.stances]
        feet = planted(leg.foot, moments)
        d = limb_roots(skeleton, leg.limb, body(feet.times))[1] - feet.ankle
        zero, swing = np.zeros(len(d)), np.arctan2(-d[:, 2], d[:, 1])
        reach = np.linalg.norm(limb_vector(leg.limb, zero + flexion, zero, swing), axis=1)
        height2 = reach**2 - d[:, 0] ** 2 - d[:, 2] ** 2
        room.append(float(np.min(np.sqrt(np.maximum(height2, 0.0)) - d[:, 1])))
    return min(room)


def raised(body: Body, height: float) -> Body:
    """Return the same body higher above the ground.

    Parameters
    ----------
    body : Body
        Any.
    height : float
        Metres.

    Returns
    -------
    Body
        With its root moved up.
    """

    def lifted(times: FloatArray) -> BodyPose:
        pose = body(times)
        return BodyPose(pose.root_position + np.array([0.0, height, 0.0]), pose.rotations, pose.heading)

    return lifted
