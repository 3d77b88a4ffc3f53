"""Gaits of the animal: gallop and walk."""

from __future__ import annotations

from math import pi, radians, sqrt

from tempose.clips import Skeleton
from tempose.samples.motion_animal import AnimalGait, animal_gait
from tempose.samples.motion_animal_body import STYLE_FIELDS, AnimalStyle, animal_body, degrees, hip_height
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.motion_human import GRAVITY
from tempose.samples.motion_timing import check_speed, frame_times, performed


def gallop(
    skeleton: Skeleton,
    *,
    duration: float = 3.0,
    fps: float = 60.0,
    speed: float | None = None,
    loop: bool = False,
    seed: int | None = None,
) -> SampleMotion:
    """Gallop along +Z: left hind, right hind, left fore, right fore, then all four gathered in the air.

    Parameters
    ----------
    skeleton : Skeleton
        An animal, of any size.
    duration : float, default 3.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    speed : float, optional
        Metres per second; about 6 for a pony when not given.
    loop : bool, default False
        Whether the clip holds whole strides, so that the frame after the last is the first, moved on.
    seed : int, optional
        Makes one performer differ from another; None is the plain gallop.

    Returns
    -------
    SampleMotion
        The left hind hoof lands at frame 0.

    Raises
    ------
    ValueError
        If the speed is none at which one gallops.
    """
    H = hip_height(skeleton)
    froude = sqrt(GRAVITY * H)
    speed = 2.0 * froude if speed is None else speed
    check_speed(speed, 1.5 * froude, 2.4 * froude, "gallop")
    pace = speed / (2.0 * froude)
    period = 1.62 * sqrt(H / GRAVITY) * pace**-0.15
    times, stride = frame_times(duration, fps, period if loop else None)
    period = stride if loop else period
    # the bob of a body that is just weightless at its highest point, in the middle of the suspension
    bob = 0.9 * GRAVITY * (period / (2.0 * pi)) ** 2
    style = AnimalStyle(
        beats=1,
        bob=bob,
        crest=0.89,
        drop=0.045 * H,
        pitch=radians(5),
        pitch_crest=0.62,
        tuck=(radians(4), radians(10)),
        tuck_crest=0.95,
        neck=radians(26),
        nod=radians(8),
        nod_crest=0.72,
        bend=0.0,
        tail=radians(54),
        tail_swing=(radians(8), 0.0),
    )
    body = animal_body(skeleton, performed(style, seed, STYLE_FIELDS), speed, period)
    return animal_gait(skeleton, _galloping(H, period, pace), body, speed, times, fps, "gallop")


def _galloping(H: float, period: float, pace: float) -> AnimalGait:
    return AnimalGait(
        period=period,
        duty=0.25 / pace**0.6,
        phases={"left_hind": 0.0, "right_hind": 0.13, "left_fore": 0.38, "right_fore": 0.52},
        ahead={"hind": 0.06 * H, "fore": 0.02 * H},
        landing=radians(4),
        flat=(0.1, 0.6),
        push=radians(55),
        via={
            "hind": (
                degrees(at=0.25, flexion=29, pitch=95),
                degrees(at=0.5, flexion=54, pitch=80),
                degrees(at=0.8, flexion=29, pitch=5),
            ),
            "fore": (
                degrees(at=0.25, flexion=17, pitch=110, fold=60),
                degrees(at=0.5, flexion=29, pitch=115, fold=95),
                degrees(at=0.8, flexion=11, pitch=15, fold=25),
            ),
        },
    )


def animal_walk(
    skeleton: Skeleton,
    *,
    duration: float = 4.0,
    fps: float = 60.0,
    speed: float | None = None,
    loop: bool = False,
    seed: int | None = None,
) -> SampleMotion:
    """Walk on four legs along +Z: left hind, left fore, right hind, right fore, evenly spaced.

    Parameters
    ----------
    skeleton : Skeleton
        An animal, of any size.
    duration : float, default 4.0
        Seconds.
    fps : float, default 60.0
        Frames per second.
    speed : float, optional
        Metres per second; about 1.2 for a pony when not given.
    loop : bool, default False
        Whether the clip holds whole strides, so that the frame after the last is the first, moved on.
    seed : int, optional
        Makes one performer differ from another; None is the plain walk.

    Returns
    -------
    SampleMotion
        The left hind hoof lands at frame 0.

    Raises
    ------
    ValueError
        If the speed is none at which one walks.
    """
    H = hip_height(skeleton)
    froude = sqrt(GRAVITY * H)
    speed = 0.40 * froude if speed is None else speed
    check_speed(speed, 0.2 * froude, 0.52 * froude, "walk")
    period = 3.3 * sqrt(H / GRAVITY) * (0.40 * froude / speed) ** 0.5
    times, stride = frame_times(duration, fps, period if loop else None)
    period = stride if loop else period
    style = AnimalStyle(
        beats=2,
        bob=0.010 * H,
        crest=0.35,
        drop=0.02 * H,
        pitch=radians(0.8),
        pitch_crest=0.3,
        tuck=(0.0, radians(1.5)),
        tuck_crest=0.95,
        neck=radians(12),
        nod=radians(5),
        nod_crest=0.36,
        bend=radians(3),
        tail=radians(6),
        tail_swing=(radians(2), radians(5)),
    )
    body = animal_body(skeleton, performed(style, seed, STYLE_FIELDS), speed, period)
    return animal_gait(skeleton, _walking(H, period), body, speed, times, fps, "walk")


def _walking(H: float, period: float) -> AnimalGait:
    return AnimalGait(
        period=period,
        duty=0.64,
        phases={"left_hind": 0.0, "left_fore": 0.25, "right_hind": 0.5, "right_fore": 0.75},
        ahead={"hind": 0.05 * H, "fore": 0.01 * H},
        landing=radians(6),
        flat=(0.1, 0.72),
        push=radians(42),
        via={
            "hind": (
                degrees(at=0.25, flexion=22, pitch=70),
                degrees(at=0.5, flexion=30, pitch=45),
                degrees(at=0.8, flexion=8, pitch=-2),
            ),
            "fore": (
                degrees(at=0.25, flexion=8, pitch=75, fold=35),
                degrees(at=0.5, flexion=12, pitch=70, fold=48),
                degrees(at=0.8, flexion=0, pitch=5, fold=12),
            ),
        },
    )
