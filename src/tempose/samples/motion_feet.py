"""A foot on the ground: it rolls over heel, ball and toes without sliding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.rotations import rotate
from tempose.samples.motion_curves import about
from tempose.typing import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Foot:
    """Where a foot touches the ground, in its own basis at rest, origin on the ground below the ankle."""

    joint: int
    """Ankle, or fetlock of an animal."""
    toes: int | None
    """Joint of the toes, None for a hoof."""
    ankle: FloatArray
    """(3,) metres, straight above the origin."""
    hinge: FloatArray
    """(3,) metres, joint of the toes; the tip of a hoof."""
    soles: tuple[tuple[str, int, FloatArray], ...]
    """Name, joint and place (3,) in that joint's basis of each point that touches the ground."""

    @property
    def heel(self) -> FloatArray:
        """(3,) metres, the point about which the foot rolls after it lands."""
        return self.soles[0][2] + self.ankle

    @property
    def tip(self) -> FloatArray:
        """(3,) metres, the last point to leave the ground."""
        _, joint, place = self.soles[-1]
        return place + (self.ankle if joint == self.joint else self.hinge)


def make_foot(
    skeleton: Skeleton, name: str, toes: str | None = None, heel: float = 0.4, toe: float = 1.0
) -> Foot:
    """Find the sole of a foot: ground is at height zero in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        With tips for the leaf of the foot.
    name : str
        Joint of the foot; its points are called ``name_heel`` and so on.
    toes : str, optional
        Joint of the toes.
    heel : float, default 0.4
        How far the heel lies behind the ankle, as a part of the way from ankle to toes.
    toe : float, default 1.0
        How far ahead the foot touches the ground, as a part of the way to its tip.

    Returns
    -------
    Foot
        Heel, ball (with toes) and tip.
    """
    positions = rest_transforms(skeleton)[1]
    joint = skeleton.index(name)
    ankle = np.array([0.0, positions[joint, 1], 0.0])
    last = joint if toes is None else skeleton.index(toes)
    assert skeleton.tips is not None
    tip = skeleton.tips[last] * (1.0, 0.0, toe) + (0.0, -positions[last, 1], 0.0)
    if toes is None:
        back = np.array([0.0, -positions[joint, 1], -heel * float(skeleton.tips[last, 2])])
        soles = ((f"{name}_heel", joint, back), (f"{name}_tip", joint, tip))
        return Foot(joint, None, ankle, ankle + tip, soles)
    forward = skeleton.offsets[last]
    back = -heel * forward * (1.0, 0.0, 1.0) - ankle
    ball = np.array([0.0, -positions[last, 1], 0.0])
    soles = ((f"{name}_heel", joint, back), (f"{name}_ball", last, ball), (f"{name}_tip", last, tip))
    return Foot(joint, last, ankle, ankle + forward, soles)


def ankle_of_rolling_foot(foot: Foot, pitch: FloatArray, toe_pitch: FloatArray) -> FloatArray:
    """Place of the ankle while the foot rolls about a point that stays where it is.

    Parameters
    ----------
    foot : Foot
        The foot.
    pitch : (T,) float
        Radians, positive with the heel up: negative rolls about the heel, positive about the toe joint.
    toe_pitch : (T,) float
        Radians, positive when the toes roll about their tip.

    Returns
    -------
    (T, 3) ndarray
        Metres, in the basis of the flat foot.
    """
    on_heel = foot.heel + rotate(about("x", pitch), foot.ankle - foot.heel)
    hinge = foot.tip + rotate(about("x", toe_pitch), foot.hinge - foot.tip)
    on_toes = hinge + rotate(about("x", pitch), foot.ankle - foot.hinge)
    return np.where(pitch[:, None] < 0, on_heel, on_toes)


def sole_contacts(foot: Foot, pitch: FloatArray, toe_pitch: FloatArray) -> BoolArray:
    """Which points of a standing foot touch the ground.

    Parameters
    ----------
    foot : Foot
        The foot, with S points.
    pitch, toe_pitch : (T,) float
        Radians, as for `ankle_of_rolling_foot`.

    Returns
    -------
    (T, S) ndarray of bool
        True where the point rests on the ground.
    """
    heel, tip = pitch <= 0, pitch >= 0
    columns = [heel, tip] if foot.toes is None else [heel, tip & (toe_pitch <= 0), tip]
    return np.stack(columns, axis=1)


def lowest_point(foot: Foot, pitch: FloatArray, toe_bend: FloatArray) -> FloatArray:
    """Height of the lowest sole point over the ankle, for a foot in the air.

    Parameters
    ----------
    foot : Foot
        The foot.
    pitch : (T,) float
        Pitch of the foot, radians.
    toe_bend : (T,) float
        Bend of the toes against the foot, radians.

    Returns
    -------
    (T,) ndarray
        Metres, negative.
    """
    turn, heights = about("x", pitch), np.zeros((len(foot.soles), len(pitch)))
    for k, (_, joint, place) in enumerate(foot.soles):
        local = (
            place if joint == foot.joint else foot.hinge - foot.ankle + rotate(about("x", toe_bend), place)
        )
        heights[k] = rotate(turn, local)[:, 1]
    return heights.min(axis=0)
