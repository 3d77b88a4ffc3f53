"""Smooth functions of time that motions are made of."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.rotations import from_rotation_vector
from tempose.typing import FloatArray


def ease(s: FloatArray) -> FloatArray:
    """Rise from 0 to 1 with zero velocity and acceleration at both ends (quintic).

    Parameters
    ----------
    s : (...) float
        Progress; clipped to 0 to 1.

    Returns
    -------
    (...) ndarray
        ``10 s^3 - 15 s^4 + 6 s^5``.
    """
    s = np.clip(np.asarray(s, dtype=np.float64), 0.0, 1.0)
    return s**3 * (10.0 + s * (6.0 * s - 15.0))


def rock(s: FloatArray, speed: float) -> FloatArray:
    """Rise from 0 to 1, starting from rest and ending while still moving.

    Parameters
    ----------
    s : (...) float
        Progress; negative values give 0.
    speed : float
        Derivative at the end.

    Returns
    -------
    (...) ndarray
        ``s^3 (1 + (3 - speed) (1 - s))``.
    """
    s = np.maximum(np.asarray(s, dtype=np.float64), 0.0)
    return s**3 * (1.0 + (3.0 - speed) * (1.0 - s))


def wave(phase: FloatArray, peak: float, harmonic: int = 1) -> FloatArray:
    """Cosine with its crest at a given phase.

    Parameters
    ----------
    phase : (...) float
        Cycles.
    peak : float
        Phase of the crest, cycles.
    harmonic : int, default 1
        Crests a cycle.

    Returns
    -------
    (...) ndarray
        Values from -1 to 1.
    """
    return np.cos(2.0 * np.pi * harmonic * (np.asarray(phase, dtype=np.float64) - peak))


def bridge(s: FloatArray, start: FloatArray, end: FloatArray, via: FloatArray, at: FloatArray) -> FloatArray:
    """Curves with value and velocity given at both ends and values in between.

    Parameters
    ----------
    s : (T,) float
        Progress, 0 to 1.
    start, end : (2, d) float
        Value and derivative by `s` of d curves.
    via : (k, d) float
        Values to pass through; NaN leaves a curve free there.
    at : (k,) float
        Where, strictly between 0 and 1, increasing.

    Returns
    -------
    (T, d) ndarray
        Cubic splines: of all curves that fit, those with the least squared acceleration.
    """
    curves = np.zeros((len(s), start.shape[1]))
    known = np.isfinite(via)
    for pattern in np.unique(known, axis=1).T:
        same = (known == pattern[:, None]).all(axis=0)
        x = np.concatenate([[0.0], at[pattern], [1.0]])
        y = np.concatenate([start[:1, same], via[np.ix_(pattern, same)], end[:1, same]])
        ends: Any = ((1, start[1, same]), (1, end[1, same]))
        curves[:, same] = CubicSpline(x, y, bc_type=ends)(s)
    return curves


def jet(values: FloatArray, step: float) -> FloatArray:
    """Value and derivative at the first of five equidistant samples, by one-sided differences.

    Parameters
    ----------
    values : (5, d) float
        Samples; the first is where the derivative is wanted.
    step : float
        Distance between samples; negative when they run backwards.

    Returns
    -------
    (2, d) ndarray
        Value and derivative, of fourth order.
    """
    slope = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / (12.0 * step)
    return np.stack([values[0], slope @ values])


def about(axis: str, angle: FloatArray | float) -> FloatArray:
    """Rotations about a coordinate axis.

    Parameters
    ----------
    axis : str
        ``"x"`` (positive: lean forward, toes down, knee bent), ``"y"`` (positive: turn left) or ``"z"``
        (positive: left side up).
    angle : (...) float
        Radians.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz.
    """
    angle = np.asarray(angle, dtype=np.float64)
    return from_rotation_vector(angle[..., None] * np.eye(3)["xyz".index(axis)])
