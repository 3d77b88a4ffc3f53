"""Walking round a bend until one faces backwards."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
from scipy.integrate import cumulative_simpson
from scipy.interpolate import CubicSpline

from tempose.clips import Skeleton
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_curves import ease
from tempose.samples.motion_gait import human_gait
from tempose.samples.motion_human import GRAVITY, STYLE_FIELDS, BodyStyle, Path, leg_length
from tempose.samples.motion_timing import check_speed, frame_times, performed
from tempose.samples.walk import walking_gait, walking_period
from tempose.typing import FloatArray


def turn(
    skeleton: Skeleton,
    *,
    duration: float = 5.0,
    fps: float = 60.0,
    speed: float | None = None,
    angle: float = pi,
    rate: float = 1.25,
    seed: int | None = None,
) -> SampleMotion:
    """Walk, turn round in the middle of the clip, walk on.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 5.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    speed : float, optional
        Metres per second before and after the turn, where it falls to about half; about 1.1 when not given.
    angle : float, default pi
        Radians, positive to the left.
    rate : float, default 1.25
        Mean angular speed in the turn, radians per second.
    seed : int, optional
        Makes one performer differ from another.

    Returns
    -------
    SampleMotion
        Head and chest look ahead into the turn, the body leans into it.

    Raises
    ------
    ValueError
        If the speed is none at which one walks, or the rate is not above 0 and at most 2.5.
    """
    if not 0 < rate <= 2.5:
        raise ValueError(f"rate must be above 0 and at most 2.5 radians per second, got {rate}")
    L = leg_length(skeleton)
    froude = sqrt(GRAVITY * L)
    speed = 0.36 * froude if speed is None else speed
    check_speed(speed, 0.15 * froude, 0.55 * froude, "turn")
    period = 0.95 * walking_period(L, speed)
    times, _ = frame_times(duration, fps)
    gait = walking_gait(L, speed, period)
    gait = replace(gait, width=1.3 * gait.width)
    style = performed(BodyStyle(sway=0.022 * L), seed, STYLE_FIELDS)
    path = bend(speed, angle, abs(angle) / rate, duration, 3.0 * period)
    return human_gait(skeleton, gait, style, path, times, fps, "turn")


def bend(speed: float, angle: float, time: float, duration: float, margin: float) -> Path:
    """Path that is straight, bends in the middle, and is straight again.

    Parameters
    ----------
    speed : float
        Metres per second on the straight.
    angle : float
        Radians, positive to the left.
    time : float
        Seconds that the bend takes.
    duration : float
        Seconds of the clip, the bend in its middle.
    margin : float
        Seconds before and after the clip for which the path is known.

    Returns
    -------
    callable
        Place and heading as functions of time; both start at zero at time 0, with the bend yet to come.
    """
    t = np.linspace(-margin, duration + margin, 4001)
    s = (t - duration / 2.0) / max(time, 1e-3) + 0.5
    bump = ease(s / 0.3) * ease((1.0 - s) / 0.3)
    turned = cumulative_simpson(bump, x=t, initial=0)
    heading = angle * turned / turned[-1]
    pace = speed * (1.0 - 0.45 * bump)
    x, z = (cumulative_simpson(pace * f(heading), x=t, initial=0) for f in (np.sin, np.cos))
    curve = CubicSpline(t, np.stack([x, 0 * x, z, heading], axis=1))
    start = curve(0.0)

    def path(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        rows = curve(times)
        return rows[:, :3] - start[:3], rows[:, 3]

    return path
