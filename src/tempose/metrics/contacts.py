"""When a foot stands on the ground, judged on the source motion."""

from __future__ import annotations

import math

import numpy as np

from tempose._validate import as_floats
from tempose.typing import BoolArray, FloatArray

WINDOW = 1 / 30
"""Seconds over which velocities are taken: shorter ones measure the noise of fast cameras."""


def velocities(points: FloatArray, fps: float, window: float = WINDOW) -> FloatArray:
    """Velocity of points by central differences over a window of fixed duration.

    Parameters
    ----------
    points : (T, k, 3) float
        Positions, metres.
    fps : float
        Frames per second.
    window : float, default 1/30
        Length of the window, seconds; between frames positions are interpolated linearly, so that a window
        shorter than two frames is two frames long.

    Returns
    -------
    (T, k, 3) ndarray
        Metres per second; one-sided at both ends, zero for a single frame.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or `fps` or `window` is not positive.
    """
    points = as_floats(points, "points", ("T", "k", 3))
    _check_positive(fps, "fps")
    _check_positive(window, "window")
    T = len(points)
    if T < 2:
        return np.zeros_like(points)
    frame = np.arange(T)
    reach = max(window * fps / 2, 1.0)
    before, after = np.maximum(frame - reach, 0), np.minimum(frame + reach, T - 1)
    span = (after - before) / fps
    return (_sample(points, after) - _sample(points, before)) / span[:, None, None]


def _sample(points: FloatArray, frame: FloatArray) -> FloatArray:
    if not (frame % 1).any():
        return points[frame.astype(int)]
    low = np.minimum(frame.astype(int), len(points) - 2)
    s = (frame - low)[:, None, None]
    return (1 - s) * points[low] + s * points[low + 1]


def detect_contacts(
    feet: FloatArray, height: float, fps: float, low: float = 0.03, slow: float = 0.25
) -> BoolArray:
    """Find the frames in which each foot is on the ground.

    Parameters
    ----------
    feet : (T, k, 3) float
        Trajectory of one point a foot of the *source*, metres; any number of feet.
    height : float
        Height of the source character, metres.
    fps : float
        Frames per second.
    low : float, default 0.03
        A foot in contact is less than this share of `height` above its own 5th percentile.
    slow : float, default 0.25
        A foot in contact moves by less than this share of `height` per second, vertical motion counted.

    Returns
    -------
    (T, k) ndarray of bool
        Whether the foot is in contact.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or `height` or `fps` is not positive.

    Notes
    -----
    Invariant to translation, to turns about the vertical, to scale (with `height`) and to reversing time.
    """
    feet = as_floats(feet, "feet", ("T", "k", 3))
    _check_positive(height, "height")
    speed = np.linalg.norm(velocities(feet, fps), axis=-1)
    if feet.size == 0:
        return np.zeros(feet.shape[:2], dtype=bool)
    ground = np.percentile(feet[..., 1], 5, axis=0)
    return (feet[..., 1] < ground + low * height) & (speed < slow * height)


def _check_positive(value: float, name: str) -> None:
    if not 0 < value < math.inf:
        raise ValueError(f"{name} must be positive, got {value}")
