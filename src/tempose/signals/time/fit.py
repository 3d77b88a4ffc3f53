"""Fitting the time signal: few controls that follow the frames through the pose plane (section 3.2.3)."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import solve_banded

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
        Controls, 4 to n + 2; with n + 1 or n + 2 the curve runs through every frame, with bends as little
        as it can (natural ends).
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
    knots = averaged_knots(t, k)
    return _one_free(knots, t, P) if k == n + 1 else least_squares_spline(knots, t, P)


def _one_free(knots: FloatArray, t: FloatArray, P: FloatArray) -> Spline:
    # through all points with one control to spare: one solution, and along what is free the least bending
    k, c = len(knots) - 4, P.shape[1]
    spare = np.zeros((k, 1))
    spare[k // 2] = 1.0
    rows = np.concatenate([P, -Spline(knots, spare)(t)], axis=1)
    found = _without_control(knots, t, rows, k // 2)
    free = found[:, c:] + spare
    bending = Spline(knots, found[:, :c]), Spline(knots, free)
    breaks = bending[0].breaks
    h, ends = np.diff(breaks)[:, None], [curve(breaks, 2) for curve in bending]

    def product(a: FloatArray, b: FloatArray) -> FloatArray:  # of two broken lines, exactly
        return (h / 6 * (2 * (a[:-1] * b[:-1] + a[1:] * b[1:]) + a[:-1] * b[1:] + a[1:] * b[:-1])).sum(0)

    along = product(ends[0], ends[1]) / product(ends[1], ends[1])
    return Spline(knots, found[:, :c] - free * along)


def _without_control(knots: FloatArray, t: FloatArray, rows: FloatArray, j: int) -> FloatArray:
    # a square system of four neighbours: as a banded one it is solved in no time
    B = BSpline.design_matrix(t, knots, 3).tocoo()
    keep = B.col != j
    row, column, value = B.row[keep], B.col[keep], B.data[keep]
    column = column - (column > j)
    low, high = int((row - column).max()), int((column - row).max())
    band = np.zeros((low + high + 1, len(t)))
    band[high + row - column, column] = value
    return np.insert(solve_banded((low, high), band, rows), j, 0.0, axis=0)


def _closed(t: FloatArray, P: FloatArray, k: int) -> Spline:
    spans = k - 3
    if spans == len(t) - 1:
        return periodic_spline(t[:-1], P[:-1], t[-1] - t[0])
    breaks = averaged_knots(t, k)[3:-3]
    at = np.arange(-3, spans + 4)
    knots = breaks[at % spans] + (breaks[-1] - breaks[0]) * (at // spans)
    wrapped = np.arange(spans + 3) % spans
    B = np.zeros((len(t) - 1, spans))
    full = BSpline.design_matrix(t[:-1], knots, 3).toarray()
    for column, of in enumerate(wrapped):
        B[:, of] += full[:, column]
    controls = np.linalg.lstsq(B, P[:-1], rcond=None)[0]
    return slice_spline(Spline(knots, controls[wrapped]), t[0], t[-1])
