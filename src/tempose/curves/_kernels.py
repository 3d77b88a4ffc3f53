"""Loops of the curves: basis of a cubic B-spline and cubic Hermite pieces at many places."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray


@njit(cache=True)
def span_of(knots: FloatArray, u: float) -> int:
    """Return i with ``knots[i] <= u < knots[i + 1]``, i from 3 to k - 1 (the last at the end of the domain).

    Parameters
    ----------
    knots : (k + 4,) float
        Knots of a cubic.
    u : float
        Place inside the domain.

    Returns
    -------
    int
        The span.
    """
    low, high = 3, len(knots) - 4
    while high - low > 1:
        middle = (low + high) // 2
        if u < knots[middle]:
            high = middle
        else:
            low = middle
    while low > 3 and knots[low + 1] <= knots[low]:  # only at the end of the domain: an empty span
        low -= 1
    return low


@njit(cache=True)
def basis(knots: FloatArray, i: int, u: float, degree: int) -> FloatArray:
    """Return the degree + 1 B-splines that live on span i, at u (de Boor's recurrence).

    Parameters
    ----------
    knots : (k + 4,) float
        Knots.
    i : int
        Span.
    u : float
        Place.
    degree : int
        0 to 3.

    Returns
    -------
    (4,) ndarray
        Values; those past the degree are 0.
    """
    out = np.zeros(4)
    out[0] = 1.0
    for p in range(1, degree + 1):
        saved = 0.0
        for r in range(p):
            right, left = knots[i + r + 1] - u, u - knots[i + 1 - p + r]
            share = out[r] / (right + left)
            out[r] = saved + right * share
            saved = left * share
        out[p] = saved
    return out


@njit(cache=True)
def basis_derivative(knots: FloatArray, i: int, u: float, order: int) -> FloatArray:
    """Return what the four controls of span i weigh in a derivative at u.

    Parameters
    ----------
    knots : (k + 4,) float
        Knots of a cubic.
    i : int
        Span.
    u : float
        Place.
    order : int
        0 to 3.

    Returns
    -------
    (4,) ndarray
        Weights of controls i - 3 .. i.
    """
    weights = basis(knots, i, u, 3 - order)
    for level in range(order, 0, -1):  # differences of controls, transposed
        degree = 4 - level
        for r in range(degree, -1, -1):
            here = 0.0
            if r > 0:
                here += weights[r - 1] / (knots[i + r] - knots[i + r - degree])
            if r < degree:
                here -= weights[r] / (knots[i + r + 1] - knots[i + r + 1 - degree])
            weights[r] = degree * here
    return weights


@njit(cache=True)
def evaluate_spline(knots: FloatArray, controls: FloatArray, u: FloatArray, order: int) -> FloatArray:
    """Evaluate a cubic B-spline curve.

    Parameters
    ----------
    knots : (k + 4,) float
        Knots.
    controls : (k, c) float
        Control points.
    u : (N,) float
        Places, clipped to the domain.
    order : int
        Derivative, 0 to 3.

    Returns
    -------
    (N, c) ndarray
        Values.
    """
    k, c = controls.shape
    first, last = knots[3], knots[k]
    out = np.zeros((len(u), c))
    for n in range(len(u)):
        x = min(max(u[n], first), last)
        i = span_of(knots, x)
        weights = basis_derivative(knots, i, x, order) if order else basis(knots, i, x, 3)
        for r in range(4):
            weight, row = weights[r], i - 3 + r
            for d in range(c):
                out[n, d] += weight * controls[row, d]
    return out


@njit(cache=True)
def evaluate_hermite(
    keys: FloatArray, values: FloatArray, slopes: FloatArray, t: FloatArray, order: int
) -> FloatArray:
    """Evaluate a piecewise cubic given by values and slopes.

    Parameters
    ----------
    keys, values, slopes : (K,) float
        The map.
    t : (N,) float
        Places, clipped to the domain.
    order : int
        Derivative, 0 or 1.

    Returns
    -------
    (N,) ndarray
        Values.
    """
    out = np.zeros(len(t))
    for n in range(len(t)):
        x = min(max(t[n], keys[0]), keys[-1])
        i = min(max(np.searchsorted(keys, x, side="right") - 1, 0), len(keys) - 2)
        h = keys[i + 1] - keys[i]
        s = (x - keys[i]) / h
        rise, a, b = values[i + 1] - values[i], slopes[i] * h, slopes[i + 1] * h
        if order == 0:
            out[n] = values[i] + s * (a + s * (3 * rise - 2 * a - b + s * (a + b - 2 * rise)))
        else:
            out[n] = (a + s * (2 * (3 * rise - 2 * a - b) + s * 3 * (a + b - 2 * rise))) / h
    return out


@njit(cache=True)
def invert_hermite(keys: FloatArray, values: FloatArray, slopes: FloatArray, y: FloatArray) -> FloatArray:
    """Return the first places where a never falling piecewise cubic takes values.

    Parameters
    ----------
    keys, values, slopes : (K,) float
        The map.
    y : (N,) float
        Values, clipped to the range.

    Returns
    -------
    (N,) ndarray
        Places.
    """
    out = np.zeros(len(y))
    for n in range(len(y)):
        i = np.searchsorted(values, y[n], side="left") - 1
        if i < 0 or i >= len(keys) - 1:
            out[n] = keys[0] if i < 0 else keys[-1]
            continue
        h = keys[i + 1] - keys[i]
        rise, a, b = values[i + 1] - values[i], slopes[i] * h, slopes[i + 1] * h
        low, high, s = 0.0, 1.0, (y[n] - values[i]) / rise
        for _ in range(80):
            off = values[i] - y[n] + s * (a + s * (3 * rise - 2 * a - b + s * (a + b - 2 * rise)))
            if off < 0:
                low = s
            else:
                high = s
            slope = a + s * (2 * (3 * rise - 2 * a - b) + s * 3 * (a + b - 2 * rise))
            newton = s - off / slope if slope > 0 else low
            following = newton if low < newton < high else 0.5 * (low + high)
            if abs(following - s) <= 1e-16 or high - low <= 1e-16:
                break
            s = following
        out[n] = keys[i] + s * h
    return out
