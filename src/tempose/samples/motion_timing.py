"""Frames of a clip, and the seed that makes one performer differ from another."""

from __future__ import annotations

from dataclasses import replace
from math import floor
from typing import TypeVar

import numpy as np

from tempose.typing import FloatArray

Style = TypeVar("Style")


def frame_times(duration: float, fps: float, period: float | None = None) -> tuple[FloatArray, float]:
    """Find the times of the frames of a clip, and the stride that fits a loop.

    Parameters
    ----------
    duration : float
        Seconds.
    fps : float
        Frames per second.
    period : float, optional
        Seconds a stride when the clip shall loop: it becomes a whole number of frames, the clip a whole
        number of strides without the frame that repeats the first.

    Returns
    -------
    times : (T,) ndarray
        Seconds.
    stride : float
        The period, rounded to frames; 0 where none was given.

    Raises
    ------
    ValueError
        If a number is not positive.
    """
    for name, value in (("duration", duration), ("fps", fps)):
        if not 0 < value < float("inf"):
            raise ValueError(f"{name} must be positive, got {value}")
    if period is None:
        return np.arange(floor(duration * fps + 1e-9) + 1) / fps, 0.0
    frames = max(round(period * fps), 2)
    strides = max(round(duration * fps / frames), 1)
    return np.arange(strides * frames) / fps, frames / fps


def check_speed(speed: float, low: float, high: float, motion: str) -> None:
    """Refuse a speed at which a gait would not look like itself.

    Parameters
    ----------
    speed : float
        Metres per second.
    low, high : float
        Limits, metres per second.
    motion : str
        Name of the gait, for the message.

    Raises
    ------
    ValueError
        If the speed is outside the limits.
    """
    if not low <= speed <= high:
        raise ValueError(
            f"speed of a {motion} must be {low:.2f} to {high:.2f} m/s for legs of this length, got {speed}"
        )


def performed(style: Style, seed: int | None, fields: tuple[str, ...]) -> Style:
    """Vary the amplitudes of a style as one performer differs from another.

    Parameters
    ----------
    style : dataclass
        The plain style.
    seed : int or None
        Seed of the performer; None keeps the style as it is.
    fields : tuple of str
        Names of the amplitudes that vary.

    Returns
    -------
    dataclass
        Each amplitude times 0.75 to 1.3.
    """
    if seed is None:
        return style
    rng = np.random.default_rng(seed)
    factors = np.exp(rng.uniform(np.log(0.75), np.log(1.3), len(fields)))
    changes = {name: getattr(style, name) * float(f) for name, f in zip(fields, factors)}
    return replace(style, **changes)  # type: ignore[type-var]
