"""A jump from both feet: crouch, take-off, flight, landing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import radians, sqrt

import numpy as np
from scipy.interpolate import BPoly

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.motion_animate import animate
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_curves import rock
from tempose.samples.motion_feet import make_foot
from tempose.samples.motion_human import GRAVITY, leg_length
from tempose.samples.motion_keyed import (
    ARM,
    Keyed,
    constant,
    keyed,
    keyed_body,
    stance_width,
    standing_height,
)
from tempose.samples.motion_legs import Leg, swing_keys
from tempose.samples.motion_limbs import human_leg
from tempose.samples.motion_stances import Stance
from tempose.samples.motion_timing import frame_times, performed
from tempose.typing import FloatArray

RECOVERY = 0.65
"""Seconds from the lowest point of the landing to standing upright."""


@dataclass(frozen=True)
class JumpStyle:
    """What differs between performers."""

    crouch: float = 0.25
    """Depth of the crouch in leg lengths."""
    absorb: float = 0.22
    """Depth to which the landing yields."""
    arms: float = 120.0
    """How far the arms swing up, degrees."""
    lean: float = 42.0
    """Lean of the chest in the crouch, degrees."""


def jump(
    skeleton: Skeleton,
    *,
    duration: float = 3.2,
    fps: float = 60.0,
    height: float = 0.35,
    distance: float = 0.45,
    seed: int | None = None,
) -> SampleMotion:
    """Jump forwards from standing and land on both feet.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 3.2
        Seconds; the jumper stands still at the end.
    fps : float, default 60.0
        Frames per second.
    height : float, default 0.35
        How far the hips rise after the feet have left the ground, metres.
    distance : float, default 0.45
        From the place of the feet before to that after, metres.
    seed : int, optional
        Makes one performer differ from another.

    Returns
    -------
    SampleMotion
        Without any contact, the hips follow a parabola exactly.

    Raises
    ------
    ValueError
        If height or distance are more than legs of this length can do.
    """
    L = leg_length(skeleton)
    if not 0.05 * L <= height <= 0.75 * L:
        raise ValueError(f"height must be {0.05 * L:.2f} to {0.75 * L:.2f} m, got {height}")
    if not 0.0 <= distance <= L:
        raise ValueError(f"distance must be 0 to {L:.2f} m, got {distance}")
    style = performed(JumpStyle(), seed, ("crouch", "absorb", "arms", "lean"))
    times, _ = frame_times(duration, fps)
    keys, place = _trajectory(skeleton, style, height, distance)
    body = keyed_body(skeleton, _pose(style, keys, height), place)
    return animate(skeleton, body, _legs(skeleton, keys, distance), times, fps, "jump")


def _trajectory(
    skeleton: Skeleton, style: JumpStyle, height: float, distance: float
) -> tuple[FloatArray, Callable[[FloatArray], FloatArray]]:
    """Find the times of start, crouch, take-off, landing, lowest point, end; and the place of the root."""
    L = leg_length(skeleton)
    x, _, home = rest_transforms(skeleton)[1][0]
    stand = standing_height(skeleton, stance_width(skeleton), radians(8))
    up, down = stand + 0.078 * L, stand + 0.045 * L
    speed = sqrt(2.0 * GRAVITY * height)
    fall = -sqrt(speed**2 + 2.0 * GRAVITY * (up - down))
    low, deep = stand - style.crouch * L, stand - style.absorb * L * min(1.0, 0.6 + height)
    flight, push, absorb = (speed - fall) / GRAVITY, 2.0 * (up - low) / speed, 2.0 * (deep - down) / fall
    t = np.cumsum([0.35, 0.55, push, flight, absorb, RECOVERY])
    leave, arrive = 0.10 * L, distance - 0.06 * L
    drift = (arrive - leave) / flight
    rise = [
        [stand, 0, 0],
        [low, 0, 9],
        [up, speed, -GRAVITY],
        [down, fall, -GRAVITY],
        [deep, 0, 12.0 * (stand - deep) / RECOVERY**2],
        [stand, 0, 0],
    ]
    along = [[0, 0, 0], [-0.05 * L, 0, 0], [leave, drift, 0], [arrive, drift, 0]]
    along += [[distance - 0.03 * L, 0, 0], [distance, 0, 0]]
    y, z = BPoly.from_derivatives(t, rise), BPoly.from_derivatives(t, along)

    def place(times: FloatArray) -> FloatArray:
        inside = np.clip(times, t[0], t[-1])
        return np.stack([np.full(len(times), x), y(inside), home + z(inside)], axis=1)

    return t, place


def _pose(style: JumpStyle, keys: FloatArray, height: float) -> Keyed:
    apex = keys[2] + sqrt(2.0 * height / GRAVITY)
    t = np.array([*keys[:2], 0.5 * (keys[1] + keys[2]), keys[2], apex, *keys[3:]])
    lean, up = style.lean, style.arms
    arm = {name: constant(degrees) for name, degrees in zip(ARM, (0, 0, 12, 0, 5, 0))}
    arm["flexion"] = keyed(t, (-4, -38, 15, up, 1.05 * up, 0.6 * up, 12, -4))
    arm["abduction"] = keyed(t, (11, 14, 14, 16, 20, 24, 18, 11))
    arm["elbow"] = keyed(t, (18, 25, 50, 35, 30, 40, 40, 18))
    arm["shrug"] = keyed(t, (0, 0, 4, 18, 18, 8, 2, 0))
    return Keyed(
        tilt=keyed(t, (4, 0.6 * lean, 0.45 * lean, 8, 6, 12, 0.5 * lean, 4)),
        lean=keyed(t, (3, lean, 0.7 * lean, 4, 2, 16, 0.9 * lean, 3)),
        nod=keyed(t, (0, 10, 2, -12, 0, 15, 12, 0)),
        arms={"left": arm, "right": arm},
    )


def _legs(skeleton: Skeleton, keys: FloatArray, distance: float) -> list[Leg]:
    crouch, leave, land = (float(t) for t in keys[1:4])
    start = crouch + 0.3 * (leave - crouch)

    def push_off(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        toes = radians(15) * np.maximum((times - leave + 0.04) / 0.04, 0.0) ** 3
        return radians(62) * rock((times - start) / (leave - start), 2.0), toes

    def touch_down(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        return radians(38) * rock(1.0 - (times - land) / 0.13, 2.2), 0.0 * times

    via = swing_keys(
        [{"at": 0.45, "flexion": radians(28), "pitch": radians(50)}, {"at": 0.85, "flexion": radians(20)}]
    )
    width = stance_width(skeleton)
    home = float(rest_transforms(skeleton)[1][skeleton.index("left_foot"), 2])
    legs: list[Leg] = []
    for side, x in (("left", width), ("right", -width)):
        stances = [
            Stance(-1.0, leave, (x, 0.0, home), 0.0, push_off),
            Stance(land, np.inf, (x, 0.0, home + distance), 0.0, touch_down),
        ]
        foot = make_foot(skeleton, f"{side}_foot", f"{side}_toes")
        legs.append(Leg(human_leg(skeleton, side), foot, stances, *via))
    return legs
