"""Cubic splines through points: natural ends, or periodic."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from tempose._validate import as_floats
from tempose.curves.spline import Spline
from tempose.typing import FloatArray


def interpolating_spline(u: FloatArray, points: FloatArray, *, natural_start: bool = True) -> Spline:
    """Return the natural cubic spline through points.

    Parameters
    ----------
    u : (n,) float
        Ascending parameters, n >= 2.
    points : (n, c) float
        Where the curve is at those parameters.
    natural_start : bool, default True
        Whether the curve is straight at its start; else its second parameter is no knot, which needs n >= 3.

    Returns
    -------
    Spline
        With n + 2 controls, or n + 1.

    Raises
    ------
    ValueError
        If the parameters do not ascend or the shapes differ.
    """
    u = as_floats(u, "u", ("n",))
    points = as_floats(points, "points", (len(u), "c"))
    least = 2 if natural_start else 3
    if len(u) < least or (np.diff(u) <= 0).any():
        raise ValueError(f"u must hold {least} or more ascending parameters, got {len(u)}")
    ends: Any = "natural" if natural_start else ("not-a-knot", "natural")
    pieces = CubicSpline(u, points, bc_type=ends)
    breaks = u if natural_start else np.delete(u, 1)
    knots = np.concatenate([[u[0]] * 3, breaks, [u[-1]] * 3])
    return Spline(knots, controls_of(pieces, knots))


def controls_of(pieces: PPoly, knots: FloatArray) -> FloatArray:
    """Return the control points of a C2 piecewise cubic.

    Parameters
    ----------
    pieces : PPoly
        The curve, with values (c,).
    knots : (k + 4,) float
        Its breaks, the ends fourfold.

    Returns
    -------
    (k, c) ndarray
        Controls.
    """
    # the blossom of the polynomial on the middle span of a control is the control itself
    k = len(knots) - 4
    at = np.clip(np.arange(k) + 1, 3, k - 1)
    mid = 0.5 * (knots[at] + knots[at + 1])
    a, b, c = (knots[np.arange(k) + i] - mid for i in (1, 2, 3))
    p, d1, d2, d3 = (pieces(mid, nu=i) for i in range(4))
    s1, s2, s3 = (a + b + c) / 3, (a * b + b * c + c * a) / 3, a * b * c
    return p + s1[:, None] * d1 + s2[:, None] * d2 / 2 + s3[:, None] * d3 / 6


def periodic_spline(u: FloatArray, points: FloatArray, period: float) -> Spline:
    """Return one period of the periodic cubic spline through points.

    Parameters
    ----------
    u : (n,) float
        Ascending parameters within one period, n >= 2.
    points : (n, c) float
        Where the curve is at those parameters.
    period : float
        More than ``u[-1] - u[0]``.

    Returns
    -------
    Spline
        Over ``u[0] .. u[0] + period``; value, first and second derivative are the same at both ends.

    Raises
    ------
    ValueError
        If the parameters do not ascend or do not fit into one period.
    """
    u = as_floats(u, "u", ("n",))
    points = as_floats(points, "points", (len(u), "c"))
    if len(u) < 2 or (np.diff(u) <= 0).any() or not period > u[-1] - u[0]:
        raise ValueError(f"u must hold 2 or more ascending parameters within a period of {period:.6g}")
    closed = np.concatenate([u, [u[0] + period]])
    pieces = CubicSpline(closed, np.concatenate([points, points[:1]]), bc_type="periodic")
    knots = np.concatenate([[closed[0]] * 3, closed, [closed[-1]] * 3])
    return Spline(knots, controls_of(pieces, knots))
