"""A planted foot, and the state of the leg above it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tempose.rotations import rotate
from tempose.samples.motion_curves import about
from tempose.samples.motion_feet import Foot, ankle_of_rolling_foot
from tempose.samples.motion_limbs import Limb, flexion_for_length
from tempose.typing import FloatArray

STATE = ("forward", "outward", "flexion", "yaw", "pitch", "toe_bend", "fold", "knee")
"""Angles of the limb to the vertical ahead and to the left, flexion, yaw of the foot against the heading,
pitch of the foot, bend of the toes, fold, yaw of the hinges against the heading; radians."""

Roll = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Pitch of foot and toes as a function of time in seconds."""


@dataclass(frozen=True)
class Stance:
    """A foot on the ground."""

    start: float
    """Seconds."""
    end: float
    """Seconds."""
    origin: tuple[float, float, float]
    """Point on the ground below the ankle of the flat foot, metres."""
    yaw: float
    """Direction of the foot, radians about Y."""
    roll: Roll
    """How it rolls."""


@dataclass(frozen=True, eq=False)
class Planted:
    """Feet on the ground at N moments."""

    times: FloatArray
    """(N,) seconds."""
    ankle: FloatArray
    """(N, 3) metres."""
    yaw: FloatArray
    """(N,) radians."""
    pitch: FloatArray
    """(N,) radians."""
    toe_pitch: FloatArray
    """(N,) radians."""


def planted(foot: Foot, moments: Sequence[tuple[Stance, FloatArray]]) -> Planted:
    """Place a foot at some times of some stances.

    Parameters
    ----------
    foot : Foot
        The foot.
    moments : sequence of (Stance, (k,) float)
        Stances and times in each, seconds.

    Returns
    -------
    Planted
        All of them, one after the other.
    """
    rows: list[tuple[FloatArray, ...]] = []
    for stance, times in moments:
        pitch, toe_pitch = stance.roll(times)
        ankle = stance.origin + rotate(about("y", stance.yaw), ankle_of_rolling_foot(foot, pitch, toe_pitch))
        rows.append((times, ankle, np.full(len(times), stance.yaw), pitch, toe_pitch))
    return Planted(*(np.concatenate(column) for column in zip(*rows)))


def standing_state(limb: Limb, feet: Planted, hip: FloatArray, heading: FloatArray) -> FloatArray:
    """State of a leg whose foot is planted.

    Parameters
    ----------
    limb : Limb
        Bones of the leg.
    feet : Planted
        The foot at its end at N moments.
    hip : (N, 3) float
        First joint of the limb, metres.
    heading : (N,) float
        Heading of the body, radians.

    Returns
    -------
    (N, 8) ndarray
        Columns as in `STATE`.
    """
    d = rotate(about("y", -heading), feet.ankle - hip)
    length = np.linalg.norm(d, axis=1)
    forward, outward = np.arctan2(d[:, 2], -d[:, 1]), np.arcsin(d[:, 0] / length)
    zero = np.zeros(len(length))
    flexion = flexion_for_length(limb, length, zero, forward)
    toe_bend = np.where(feet.pitch < 0, 0.0, feet.toe_pitch - feet.pitch)
    yaw = feet.yaw - heading
    return np.stack([forward, outward, flexion, yaw, feet.pitch, toe_bend, zero, 0.6 * yaw], axis=1)
