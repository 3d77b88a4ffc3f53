"""Limbs and gaits of a four-legged animal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.motion_animate import animate
from tempose.samples.motion_clip import Body, SampleMotion
from tempose.samples.motion_curves import rock
from tempose.samples.motion_feet import make_foot
from tempose.samples.motion_legs import Leg, headroom, raised, swing_keys
from tempose.samples.motion_limbs import Limb
from tempose.samples.motion_stances import Roll, Stance
from tempose.typing import FloatArray

LIMBS = {"hind": ("thigh", "shin", "cannon", "hoof"), "fore": ("scapula", "upper", "lower", "cannon", "hoof")}


@dataclass(frozen=True)
class AnimalGait:
    """Timing and hooves of a gait; angles in radians, `s` is the part of the stance gone by."""

    period: float
    """Seconds a stride."""
    duty: float
    """Part of the stride for which a hoof stands."""
    phases: Mapping[str, float]
    """When each hoof, such as ``"left_hind"``, lands, in strides."""
    ahead: Mapping[str, float]
    """How far in front of its rest place a ``"hind"`` and a ``"fore"`` hoof stands, metres."""
    landing: float
    """Pitch of the hoof as it lands on its heel."""
    flat: tuple[float, float]
    """`s` when the sole is down and when the heel leaves the ground."""
    push: float
    """Pitch of the hoof as it leaves the ground."""
    via: Mapping[str, tuple[dict[str, float], ...]]
    """Where the swing of a ``"hind"`` and a ``"fore"`` limb passes, as in `swing_keys`."""
    narrow: float = 0.85
    """Distance of the hooves from the middle line, relative to the rest pose."""


def animal_limb(skeleton: Skeleton, side: str, pair: str) -> Limb:
    """Limb of a hoofed animal; the flexion is zero in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        An animal.
    side : str
        ``"left"`` or ``"right"``.
    pair : str
        ``"hind"``: stifle and hock bend together, as the reciprocal apparatus of a horse makes them; or
        ``"fore"``: shoulder and elbow bend together, the knee folds only in swing, and the shoulder blade
        takes less than its part of the swing.

    Returns
    -------
    Limb
        From hip or shoulder blade to the fetlock.
    """
    joints = tuple(skeleton.index(f"{side}_{pair}_{name}") for name in LIMBS[pair])
    bones = skeleton.offsets[list(joints[1:])]
    if pair == "hind":
        ratio, fold, swing, limits = [1.0, -1.0], [0.0, 0.0], [0.0, 0.0], (-0.55, 1.9)
    else:
        ratio, fold, swing = [1.0, -1.15, 0.0], [0.15, -0.55, 1.0], [-0.8, 0.0, 0.0]
        limits = (-0.6, 1.3)
    return Limb(joints, bones, np.array(ratio), np.array(fold), np.array(swing), np.zeros(len(ratio)), limits)


def hoof_roll(gait: AnimalGait, start: float) -> Roll:
    """Pitch of a hoof from landing to break-over.

    Parameters
    ----------
    gait : AnimalGait
        Angles and timing.
    start : float
        When the hoof lands, seconds.

    Returns
    -------
    callable
        Pitch of the hoof, and zero for the toes it does not have, as functions of time.
    """
    length = gait.duty * gait.period

    def roll(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        s = (times - start) / length
        strike = -gait.landing * rock(1.0 - s / gait.flat[0], 0.7)
        return strike + gait.push * rock((s - gait.flat[1]) / (1.0 - gait.flat[1]), 2.0), 0.0 * s

    return roll


def _leg(skeleton: Skeleton, gait: AnimalGait, key: str, speed: float, duration: float) -> Leg:
    side, pair = key.split("_")
    foot = make_foot(skeleton, f"{side}_{pair}_hoof", heel=-0.33, toe=1.5)
    x, _, z = rest_transforms(skeleton)[1][foot.joint]
    stances: list[Stance] = []
    for stride in range(-3, ceil(duration / gait.period) + 3):
        start = (stride + gait.phases[key]) * gait.period
        end = start + gait.duty * gait.period
        ahead = float(z + gait.ahead[pair] + speed * 0.5 * (start + end))
        stances.append(Stance(start, end, (float(gait.narrow * x), 0.0, ahead), 0.0, hoof_roll(gait, start)))
    return Leg(animal_limb(skeleton, side, pair), foot, stances, *swing_keys(gait.via[pair]))


def animal_gait(
    skeleton: Skeleton, gait: AnimalGait, body: Body, speed: float, times: FloatArray, fps: float, name: str
) -> SampleMotion:
    """Move an animal straight ahead.

    Parameters
    ----------
    skeleton : Skeleton
        An animal.
    gait : AnimalGait
        What the legs do.
    body : Body
        What the rest does; lowered where a leg would not reach the ground.
    speed : float
        Metres per second.
    times : (T,) float
        Seconds.
    fps : float
        Frames per second.
    name : str
        Name of the motion.

    Returns
    -------
    SampleMotion
        T frames.
    """
    legs = [_leg(skeleton, gait, key, speed, float(times[-1])) for key in gait.phases]
    room = min(headroom(skeleton, body, [leg], 0.9 * leg.limb.limits[0]) for leg in legs)
    return animate(skeleton, raised(body, min(room, 0.0)), legs, times, fps, name)
