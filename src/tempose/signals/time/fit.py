"""Fitting the time signal: few controls that follow the frames through the pose plane (section 3.2.3)."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from tempose._validate import as_floats
from tempose.curves import (
    Spline,
    interpolating_spline,
    least_squares_spline,
    monotone_map,
    periodic_spline,
    slice_spline,
)
from tempose.signals.time.parameters import averaged_knots, centripetal_parameters
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


def fit_time_signal(P: FloatArray, k: int, *, periodic: bool = False) -> TimeSignal:
    """Fit a cubic B-spline curve with k controls, and the monotone pace along it.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames in the pose plane, n >= 2.
    k : int
        Controls, 4 to n + 2; with n + 1 or n + 2 the curve runs through every frame, with natural
        end conditions as far as it is free.
    periodic : bool, default False
        Whether the last frame runs on into the first one: the curve is then closed, C2, lasts n ticks and
        takes k up to n + 3.

    Returns
    -------
    TimeSignal
        The frames at ticks 0 .. n - 1.

    Raises
    ------
    ValueError
        If there is one frame only or k is out of range.
    """
    P = as_floats(P, "P", ("n", 2))
    n = len(P)
    if n < 2:
        raise ValueError(f"a time signal needs 2 frames or more, got {n}")
    closed = np.concatenate([P, P[:1]]) if periodic else P
    most = len(closed) + 2
    if not 4 <= k <= most:
        raise ValueError(f"k must be 4 to {most} for {n} frames, got {k}")
    t = centripetal_parameters(closed)
    fit = _closed if periodic else _open
    curve = fit(t, closed, k)
    return TimeSignal(curve, curve, monotone_map(np.arange(float(len(t))), t))


def _open(t: FloatArray, P: FloatArray, k: int) -> Spline:
    n = len(t)
    if k == n + 2:
        return interpolating_spline(t, P)
    if k == n + 1:  # one knot less: the one next to the start
        return interpolating_spline(t, P, natural_start=False)
    return least_squares_spline(averaged_knots(t, k), t, P)


def _closed(t: FloatArray, P: FloatArray, k: int) -> Spline:
    spans = k - 3
    if spans == len(t) - 1:
        return periodic_spline(t[:-1], P[:-1], t[-1] - t[0])
    breaks = np.interp(np.arange(spans + 1) * ((len(t) - 1) / spans), np.arange(len(t)), t)
    at = np.arange(-3, spans + 4)
    knots = breaks[at % spans] + (breaks[-1] - breaks[0]) * (at // spans)
    wrapped = np.arange(spans + 3) % spans
    B = np.zeros((len(t) - 1, spans))
    full = BSpline.design_matrix(t[:-1], knots, 3).toarray()
    for column, of in enumerate(wrapped):
        B[:, of] += full[:, column]
    controls = np.linalg.lstsq(B, P[:-1], rcond=None)[0]
    return slice_spline(Spline(knots, controls[wrapped]), t[0], t[-1])
