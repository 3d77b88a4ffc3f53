"""Running, with a flight after every step."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, radians, sqrt

import numpy as np

from tempose.clips import Skeleton
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_gait import Gait, human_gait
from tempose.samples.motion_human import GRAVITY, STYLE_FIELDS, BodyStyle, leg_length
from tempose.samples.motion_timing import check_speed, frame_times, performed
from tempose.samples.walk import straight
from tempose.typing import FloatArray


def run(
    skeleton: Skeleton,
    *,
    duration: float = 3.0,
    fps: float = 60.0,
    speed: float | None = None,
    loop: bool = False,
    seed: int | None = None,
) -> SampleMotion:
    """Run along +Z; between two steps the body flies like a stone.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 3.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    speed : float, optional
        Metres per second; about 3.2 for an adult when not given.
    loop : bool, default False
        Whether the clip holds whole strides, so that the frame after the last is the first, moved on.
    seed : int, optional
        Makes one performer differ from another; None is the plain run.

    Returns
    -------
    SampleMotion
        The left foot lands at frame 0.

    Raises
    ------
    ValueError
        If the speed is none at which one runs.
    """
    L = leg_length(skeleton)
    froude = sqrt(GRAVITY * L)
    speed = 1.07 * froude if speed is None else speed
    check_speed(speed, 0.6 * froude, 1.6 * froude, "run")
    pace = speed / (1.07 * froude)
    period = 2.35 * sqrt(L / GRAVITY) * pace**-0.25
    times, stride = frame_times(duration, fps, period if loop else None)
    gait = running_gait(L, stride if loop else period, 0.335 * pace**-0.35)
    return human_gait(skeleton, gait, running_style(L, seed), straight(speed), times, fps, "run")


def running_style(L: float, seed: int | None) -> BodyStyle:
    """Body of a runner: leaning, elbows bent.

    Parameters
    ----------
    L : float
        Length of the leg, metres.
    seed : int or None
        Seed of the performer.

    Returns
    -------
    BodyStyle
        Amplitudes.
    """
    style = BodyStyle(
        lean=radians(9),
        tilt=radians(9),
        sway=0.008 * L,
        pelvis_yaw=radians(7),
        pelvis_roll=radians(4),
        chest_yaw=radians(9),
        arm_swing=radians(32),
        arm_offset=radians(-12),
        elbow=radians(88),
        elbow_swing=radians(10),
        abduction=radians(17),
        twist=radians(10),
        shrug=radians(2),
    )
    return performed(style, seed, STYLE_FIELDS)


def running_gait(L: float, period: float, duty: float) -> Gait:
    """Give timing and feet of a run.

    Parameters
    ----------
    L : float
        Length of the leg, metres.
    period : float
        Seconds a stride.
    duty : float
        Part of the stride for which a foot stands, below one half.

    Returns
    -------
    Gait
        What the legs do.
    """
    rows = (
        (0.22, -49, 84, 100, -15),
        (0.38, -38, 104, 92, -6),
        (0.54, -14, 98, 66, 0),
        (0.70, 9, 70, 30, 0),
        (0.86, 20, 32, 2, 0),
    )
    names = ("forward", "flexion", "pitch", "toe_bend")
    return Gait(
        period=period,
        duty=duty,
        width=0.04 * L,
        ahead=-0.2 * L,
        landing=radians(7),
        flat=(0.18, 0.32),
        push=radians(76),
        toes=radians(18),
        via=tuple({"at": at} | {n: radians(a) for n, a in zip(names, angles)} for at, *angles in rows),
        least_flexion=radians(15),
        bob=bounce(period / 2.0, duty * period),
    )


def bounce(step: float, contact: float) -> Callable[[FloatArray], FloatArray]:
    """Height of a body that is pushed up while a foot stands and falls freely in between.

    Parameters
    ----------
    step : float
        Seconds from landing to landing.
    contact : float
        Seconds for which the foot stands, shorter than the step.

    Returns
    -------
    callable
        Metres as a function of the phase of the stride of two steps, 0 at the landing.

    Notes
    -----
    The ground pushes like half a sine; twice integrated in closed form, its mean balances the weight.
    """
    push = GRAVITY * step * pi / (2.0 * contact)
    start = GRAVITY * contact / 2.0 - push * contact / pi

    def bob(phase: FloatArray) -> FloatArray:
        t = np.mod(phase, 0.5) * 2.0 * step
        u = np.minimum(t, contact)
        pushed = push * contact / pi * (u - contact / pi * np.sin(pi * u / contact))
        flight = t - u
        return start * u - GRAVITY * u**2 / 2.0 + pushed - start * flight - GRAVITY * flight**2 / 2.0

    return bob
