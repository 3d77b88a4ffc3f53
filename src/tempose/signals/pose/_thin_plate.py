"""Sums of thin-plate splines, place by place."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

# the same place gives the same bits whatever stands beside it: no sum runs across places
_FAST = {"contract", "nsz"}


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def evaluate(q: Any, s: Any, weights: Any, affine: Any, out: Any) -> None:
    """Write the values of a thin-plate spline.

    Parameters
    ----------
    q : (N, 2) float64
        Places, in units of the spline.
    s : (l, 2) float64
        Sites, in the same units.
    weights : (l, m) float64
        Of ``phi(r) = r^2 log r`` around every site.
    affine : (3, m) float64
        Constant, then the two slopes.
    out : (N, m) float64
        Written.
    """
    m = weights.shape[1]
    for i in range(len(q)):
        x, y = q[i, 0], q[i, 1]
        for c in range(m):
            out[i, c] = affine[0, c] + x * affine[1, c] + y * affine[2, c]
        for j in range(len(s)):
            dx, dy = x - s[j, 0], y - s[j, 1]
            r2 = dx * dx + dy * dy
            if r2 > 0.0:
                phi = 0.5 * r2 * np.log(r2)
                for c in range(m):
                    out[i, c] += phi * weights[j, c]


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def first_derivatives(q: Any, s: Any, weights: Any, affine: Any, out: Any) -> None:
    """Write the derivatives of a thin-plate spline by the place.

    Parameters
    ----------
    q : (N, 2) float64
        Places, in units of the spline.
    s : (l, 2) float64
        Sites, in the same units.
    weights : (l, m) float64
        Of ``r^2 log r`` around every site.
    affine : (3, m) float64
        Constant, then the two slopes.
    out : (N, 2, m) float64
        Written: by x, by y.
    """
    m = weights.shape[1]
    for i in range(len(q)):
        for c in range(m):
            out[i, 0, c] = affine[1, c]
            out[i, 1, c] = affine[2, c]
        for j in range(len(s)):
            dx, dy = q[i, 0] - s[j, 0], q[i, 1] - s[j, 1]
            r2 = dx * dx + dy * dy
            if r2 > 0.0:
                slope = np.log(r2) + 1.0
                for c in range(m):
                    out[i, 0, c] += slope * dx * weights[j, c]
                    out[i, 1, c] += slope * dy * weights[j, c]


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def second_derivatives(q: Any, s: Any, weights: Any, out: Any) -> None:
    """Write the second derivatives of a thin-plate spline by the place.

    Parameters
    ----------
    q : (N, 2) float64
        Places, in units of the spline.
    s : (l, 2) float64
        Sites, in the same units; at a site its own part, which is infinite there, is left out.
    weights : (l, m) float64
        Of ``r^2 log r`` around every site.
    out : (N, 3, m) float64
        Written: xx, xy, yy.
    """
    m = weights.shape[1]
    out[:] = 0.0
    for i in range(len(q)):
        for j in range(len(s)):
            dx, dy = q[i, 0] - s[j, 0], q[i, 1] - s[j, 1]
            r2 = dx * dx + dy * dy
            if r2 > 0.0:
                slope = np.log(r2) + 1.0
                xx, xy, yy = slope + 2 * dx * dx / r2, 2 * dx * dy / r2, slope + 2 * dy * dy / r2
                for c in range(m):
                    out[i, 0, c] += xx * weights[j, c]
                    out[i, 1, c] += xy * weights[j, c]
                    out[i, 2, c] += yy * weights[j, c]
