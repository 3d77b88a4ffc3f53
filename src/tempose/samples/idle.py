"""Standing: breathing, shifting weight, waving a hand."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, radians

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.motion_animate import animate
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_curves import ease
from tempose.samples.motion_feet import make_foot
from tempose.samples.motion_human import leg_length
from tempose.samples.motion_keyed import (
    ARM,
    Curve,
    Keyed,
    constant,
    keyed_body,
    stance_width,
    standing_height,
)
from tempose.samples.motion_legs import Leg
from tempose.samples.motion_limbs import human_leg
from tempose.samples.motion_stances import Stance
from tempose.samples.motion_timing import frame_times, performed
from tempose.typing import FloatArray

HANG = (-4.0, 11.0, 12.0, 16.0, 5.0, 0.0)
"""Degrees of a resting arm, in the order of `ARM`."""

RAISED = (25.0, 72.0, -75.0, 92.0, 0.0, 10.0)
"""Degrees of a waving arm."""


@dataclass(frozen=True)
class IdleStyle:
    """What differs between performers."""

    breath: float = 1.2
    """Swing of the chest, degrees."""
    sway: float = 0.02
    """Shift of weight, in leg lengths."""
    wag: float = 22.0
    """Swing of the waving forearm, degrees."""


def idle(
    skeleton: Skeleton,
    *,
    duration: float = 4.0,
    fps: float = 60.0,
    loop: bool = False,
    seed: int | None = None,
) -> SampleMotion:
    """Stand, breathe and shift the weight from leg to leg.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 4.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    loop : bool, default False
        Whether the clip holds whole periods, of about eight seconds.
    seed : int, optional
        Makes one performer differ from another.

    Returns
    -------
    SampleMotion
        Both feet stand all the time.
    """
    arms = {side: {name: constant(angle) for name, angle in zip(ARM, HANG)} for side in ("left", "right")}
    return _stand(skeleton, arms, duration, fps, loop, seed, "idle")


def wave_hand(
    skeleton: Skeleton, *, duration: float = 4.0, fps: float = 60.0, seed: int | None = None
) -> SampleMotion:
    """Raise the right hand, wave, lower it.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 4.0
        Seconds; the hand is up but for the first and the last.
    fps : float, default 60.0
        Frames per second.
    seed : int, optional
        Makes one performer differ from another.

    Returns
    -------
    SampleMotion
        Both feet stand all the time.
    """
    style = performed(IdleStyle(), seed, ("breath", "sway", "wag"))

    def up(t: FloatArray) -> FloatArray:
        return ease(t - 0.2) * ease(duration - 0.2 - t)

    def arm(rest: float, raised: float, wag: float) -> Curve:
        return lambda t: np.radians(rest + up(t) ** 2 * (raised - rest + wag * np.sin(2 * pi * 1.8 * t)))

    wags = (0.0, 0.15 * style.wag, 0.0, style.wag, 0.0, 0.0)
    right = {name: arm(rest, raised, wag) for name, rest, raised, wag in zip(ARM, HANG, RAISED, wags)}
    left = {name: constant(angle) for name, angle in zip(ARM, HANG)}
    return _stand(skeleton, {"left": left, "right": right}, duration, fps, False, seed, "wave")


def _stand(
    skeleton: Skeleton,
    arms: dict[str, dict[str, Curve]],
    duration: float,
    fps: float,
    loop: bool,
    seed: int | None,
    name: str,
) -> SampleMotion:
    style = performed(IdleStyle(), seed, ("breath", "sway", "wag"))
    times, period = frame_times(duration, fps, 8.0 if loop else None)
    beat = 2.0 * pi / (period or 8.0)
    L, width = leg_length(skeleton), stance_width(skeleton)
    home = rest_transforms(skeleton)[1]
    height = standing_height(skeleton, width + style.sway * L, radians(8))

    def place(t: FloatArray) -> FloatArray:
        sway = style.sway * L * np.sin(beat * t)
        return np.stack([sway, np.full(len(t), height), home[0, 2] + 0.15 * sway], axis=1)

    def breath(degrees: float) -> Curve:
        return lambda t: np.radians(degrees - style.breath * np.sin(2.0 * beat * t))

    body = keyed_body(skeleton, Keyed(constant(3), breath(2), breath(1), arms), place)
    return animate(skeleton, body, _planted(skeleton, width), times, fps, name)


def _planted(skeleton: Skeleton, width: float) -> list[Leg]:
    def flat(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        return 0.0 * times, 0.0 * times

    home = float(rest_transforms(skeleton)[1][skeleton.index("left_foot"), 2])
    return [
        Leg(
            human_leg(skeleton, side),
            make_foot(skeleton, f"{side}_foot", f"{side}_toes"),
            [Stance(-inf, inf, (x, 0.0, home), 0.0, flat)],
        )
        for side, x in (("left", width), ("right", -width))
    ]
