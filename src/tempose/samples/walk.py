"""Walking, straight ahead."""

from __future__ import annotations

from math import radians, sqrt

import numpy as np

from tempose.clips import Skeleton
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_curves import wave
from tempose.samples.motion_gait import Gait, human_gait
from tempose.samples.motion_human import GRAVITY, STYLE_FIELDS, BodyStyle, Path, leg_length
from tempose.samples.motion_timing import check_speed, frame_times, performed
from tempose.typing import FloatArray


def walk(
    skeleton: Skeleton,
    *,
    duration: float = 4.0,
    fps: float = 60.0,
    speed: float | None = None,
    loop: bool = False,
    seed: int | None = None,
) -> SampleMotion:
    """Walk along +Z: heel strike, roll over the sole, push-off from the toes.

    Parameters
    ----------
    skeleton : Skeleton
        A human, of any size.
    duration : float, default 4.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    speed : float, optional
        Metres per second; about 1.3 for an adult when not given.
    loop : bool, default False
        Whether the clip holds whole strides, so that the frame after the last is the first, moved on.
    seed : int, optional
        Makes one performer differ from another; None is the plain walk.

    Returns
    -------
    SampleMotion
        The left heel strikes at frame 0.

    Raises
    ------
    ValueError
        If the speed is none at which one walks.

    Notes
    -----
    The knee bends as it does in the mean of healthy adults [1]_;
    step length grows with speed to the power 0.42 [2]_.

    References
    ----------
    .. [1] Winter, "Biomechanics and Motor Control of Human Movement", Wiley, 2009.
    .. [2] Kuo, "A Simple Model of Bipedal Walking Predicts the Preferred Speed-Step Length Relationship",
       Journal of Biomechanical Engineering 123, 2001.
    """
    L = leg_length(skeleton)
    froude = sqrt(GRAVITY * L)
    speed = 0.43 * froude if speed is None else speed
    check_speed(speed, 0.15 * froude, 0.65 * froude, "walk")
    period = walking_period(L, speed)
    times, stride = frame_times(duration, fps, period if loop else None)
    gait = walking_gait(L, speed, stride if loop else period)
    style = performed(BodyStyle(sway=0.022 * L), seed, STYLE_FIELDS)
    return human_gait(skeleton, gait, style, straight(speed), times, fps, "walk")


def straight(speed: float) -> Path:
    """Path along +Z.

    Parameters
    ----------
    speed : float
        Metres per second.

    Returns
    -------
    callable
        Place and heading as functions of time.
    """

    def path(times: FloatArray) -> tuple[FloatArray, FloatArray]:
        zero = np.zeros_like(times)
        return np.stack([zero, zero, speed * times], axis=1), zero

    return path


def walking_period(L: float, speed: float) -> float:
    """Time of a stride at a given speed.

    Parameters
    ----------
    L : float
        Length of the leg, metres.
    speed : float
        Metres per second.

    Returns
    -------
    float
        Seconds.
    """
    step = 0.80 * L * (speed / (0.43 * sqrt(GRAVITY * L))) ** 0.42
    return 2.0 * step / speed


def walking_gait(L: float, speed: float, period: float) -> Gait:
    """Give timing and feet of a walk.

    Parameters
    ----------
    L : float
        Length of the leg, metres.
    speed : float
        Metres per second.
    period : float
        Seconds a stride.

    Returns
    -------
    Gait
        What the legs do.
    """
    step = speed * period / 2.0
    rise = 0.041 * step**2 / L
    return Gait(
        period=period,
        duty=0.62,
        width=0.06 * L,
        ahead=-0.125 * step,
        landing=radians(20) * min(step / (0.8 * L), 1.1),
        flat=(0.13, 0.62),
        push=radians(63),
        toes=radians(22),
        via=(
            {"at": 0.30, "flexion": radians(61), "pitch": radians(36), "toe_bend": radians(-20)},
            {"at": 0.64, "flexion": radians(33), "pitch": radians(-3), "toe_bend": 0.0},
            {"at": 0.86, "flexion": radians(11), "pitch": radians(-18)},
        ),
        least_flexion=radians(9),
        bob=lambda phase: -rise * wave(phase, 0.02, 2),
    )
