"""A human gait: when the feet stand, how they roll, how the legs swing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.rotations import rotate
from tempose.samples.motion_animate import animate
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_curves import about, rock
from tempose.samples.motion_feet import make_foot
from tempose.samples.motion_human import BodyStyle, Path, human_body
from tempose.samples.motion_legs import Leg, headroom, raised, swing_keys
from tempose.samples.motion_limbs import human_leg
from tempose.samples.motion_stances import Roll, Stance
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Gait:
    """Timing and feet of a gait; angles in radians, `s` is the part of the stance gone by."""

    period: float
    """Seconds a stride, from one landing of the left foot to the next."""
    duty: float
    """Part of the stride for which a foot stands."""
    width: float
    """Distance of each foot from the middle line, metres."""
    ahead: float
    """How far the foot stands in front of the body in the middle of the stance, metres."""
    landing: float
    """Pitch of the foot as it lands on the heel."""
    flat: tuple[float, float]
    """`s` when the sole is down and when the heel leaves the ground."""
    push: float
    """Pitch of the foot as it leaves the ground."""
    toes: float
    """Pitch of the toes as they leave the ground."""
    via: tuple[dict[str, float], ...]
    """Where the swing passes: ``at``, the part of it gone by, and any of the angles of `STATE`."""
    least_flexion: float
    """The knee is never straighter in stance; sets the height of the body."""
    bob: Callable[[FloatArray], FloatArray]
    """Height of the body above its mean as a function of phase, metres."""


def rolling(gait: Gait, start: float) -> Roll:
    """Roll of a foot from heel to toes.

    Parameters
    ----------
    gait : Gait
        Angles and timing.
    start : float
        When the foot lands, seconds.

    Returns
    -------
    callable
        Pitch of foot and toes as functions of time.
    """
    length = gait.duty * gait.period

    def roll(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        s = (np.asarray(times) - start) / length
        strike = -gait.landing * rock(1.0 - s / gait.flat[0], 2.0)
        push = gait.push * rock((s - gait.flat[1]) / (1.0 - gait.flat[1]), 2.0)
        toes = gait.toes * np.maximum((s - 0.85) / 0.15, 0.0) ** 3
        return strike + push, toes

    return roll


def footfalls(gait: Gait, path: Path, side: str, duration: float) -> list[Stance]:
    """Places and times of the stances of one foot, from before the start to after the end.

    Parameters
    ----------
    gait : Gait
        Timing and width.
    path : Path
        Where the body goes.
    side : str
        ``"left"`` or ``"right"``.
    duration : float
        Seconds.

    Returns
    -------
    list of Stance
        In order of time.
    """
    sign, offset = (1.0, 0.0) if side == "left" else (-1.0, 0.5)
    stances: list[Stance] = []
    for stride in range(-2, ceil(duration / gait.period) + 2):
        start = (stride + offset) * gait.period
        end = start + gait.duty * gait.period
        place, heading = path(np.array([0.5 * (start + end)]))
        x, _, z = place[0] + rotate(about("y", heading[0]), np.array([sign * gait.width, 0.0, gait.ahead]))
        stances.append(Stance(start, end, (float(x), 0.0, float(z)), float(heading[0]), rolling(gait, start)))
    return stances


def human_gait(
    skeleton: Skeleton, gait: Gait, style: BodyStyle, path: Path, times: FloatArray, fps: float, name: str
) -> SampleMotion:
    """Walk or run along a path.

    Parameters
    ----------
    skeleton : Skeleton
        A human.
    gait : Gait
        What the legs do.
    style : BodyStyle
        What the rest does.
    path : Path
        Where to go.
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
    legs = [
        Leg(
            human_leg(skeleton, side),
            make_foot(skeleton, f"{side}_foot", f"{side}_toes"),
            footfalls(gait, path, side, float(times[-1])),
            *swing_keys(gait.via),
        )
        for side in ("left", "right")
    ]
    height = float(rest_transforms(skeleton)[1][0, 1])
    body = human_body(skeleton, style, path, gait.period, height, gait.bob)
    body = raised(body, headroom(skeleton, body, legs, gait.least_flexion))
    return animate(skeleton, body, legs, times, fps, name)
