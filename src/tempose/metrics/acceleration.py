"""How hard feet accelerate: pops are seen here first."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.metrics.contacts import WINDOW
from tempose.typing import FloatArray


@dataclass(frozen=True)
class AccelerationRatio:
    """Acceleration of one motion over that of another."""

    rms: float
    """Of their root mean squares."""
    p99: float
    """Of their 99th percentiles."""
    max: float
    """Of their largest values: one pop of one foot is seen here."""


def accelerations(points: FloatArray, fps: float, window: float = WINDOW) -> FloatArray:
    """Acceleration of points by second differences over a window of fixed duration.

    Parameters
    ----------
    points : (T, k, 3) float
        Positions, metres.
    fps : float
        Frames per second.
    window : float, default 1/30
        Seconds; the second difference spans this long, or two frames where that is longer.

    Returns
    -------
    (T', k, 3) ndarray
        Metres per second squared, without the frames at either end whose window is not full.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or `fps` or `window` is not positive.
    """
    points = as_floats(points, "points", ("T", "k", 3))
    for value, name in ((fps, "fps"), (window, "window")):
        if not 0 < value < math.inf:
            raise ValueError(f"{name} must be positive, got {value}")
    reach = max(round(window * fps / 2), 1)
    if len(points) <= 2 * reach:
        return points[:0]
    middle = points[reach:-reach]
    return (points[2 * reach :] - 2 * middle + points[: -2 * reach]) * (fps / reach) ** 2


def foot_acceleration(
    feet: FloatArray, source: FloatArray, scale: float, fps: float
) -> AccelerationRatio | None:
    """Compare how hard the feet of a target accelerate with those of its source.

    Parameters
    ----------
    feet : (T, k, 3) float
        One point a foot of the target, metres.
    source : (T, k, 3) float
        The same points of the source, metres.
    scale : float
        Size of the target over that of the source, such as the ratio of leg lengths.
    fps : float
        Frames per second.

    Returns
    -------
    AccelerationRatio or None
        1 for a target that moves like its source; None where the source does not accelerate or the clip is
        too short.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or `scale` or `fps` is not positive.
    """
    feet = as_floats(feet, "feet", ("T", "k", 3))
    source = as_floats(source, "source", feet.shape)
    if not 0 < scale < math.inf:
        raise ValueError(f"scale must be positive, got {scale}")
    ours = np.linalg.norm(accelerations(feet, fps), axis=-1)
    theirs = scale * np.linalg.norm(accelerations(source, fps), axis=-1)
    if ours.size == 0 or not theirs.any():
        return None
    rms = float(np.sqrt((ours**2).mean() / (theirs**2).mean()))
    top = float(np.percentile(theirs, 99))
    p99 = float(np.percentile(ours, 99)) / top if top > 0 else rms
    return AccelerationRatio(rms, p99, float(ours.max() / theirs.max()))
