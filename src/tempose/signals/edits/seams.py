"""Splines and clocks that run from one place over into another: two ends and a new piece between them."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from tempose.curves import MonotoneMap, Spline
from tempose.typing import FloatArray


def middle_spline(u: FloatArray, before: FloatArray, after: FloatArray, inner: FloatArray) -> Spline:
    """Return a spline that meets value and two derivatives at both ends and points between.

    Parameters
    ----------
    u : (N + 2,) float
        Ascending parameters: begin, the N points, end.
    before, after : (3, c) float
        Value, first and second derivative at the begin and the end.
    inner : (N, c) float
        Where the curve is at the inner parameters.

    Returns
    -------
    Spline
        With N + 6 controls; joined to what is before and after, it is C2.
    """
    extra = (u[:1] + u[1:2], u[-2:-1] + u[-1:]) if len(inner) else (2 * u[:1] + u[1:], u[:1] + 2 * u[1:])
    share = 2.0 if len(inner) else 3.0
    knots = np.sort(np.concatenate([[u[0]] * 3, u, [u[-1]] * 3, *(e / share for e in extra)]))
    k = len(knots) - 4
    basis = BSpline(knots, np.eye(k), 3)
    rows = [basis(u[0], nu=i) for i in range(3)] + [basis(u[-1], nu=i) for i in range(3)]
    span = u[-1] - u[0]
    scale = np.array([1.0, span, span**2, 1.0, span, span**2])[:, None]
    A = np.concatenate([scale * np.array(rows), basis(u[1:-1])])
    b = np.concatenate([scale * np.concatenate([before, after]), inner])
    return Spline(knots, np.linalg.solve(A, b))


def derivatives(spline: Spline, u: float) -> FloatArray:
    """Return value, first and second derivative of a spline.

    Parameters
    ----------
    spline : Spline
        Any.
    u : float
        Where.

    Returns
    -------
    (3, c) ndarray
        The rows that `middle_spline` takes.
    """
    return np.array([spline(u, derivative=i) for i in range(3)])


def join_splines(left: Spline, a: float, middle: Spline, right: Spline, b: float) -> Spline:
    """Join a spline up to a place, a new piece and a spline from a place on.

    Parameters
    ----------
    left, right : Spline
        What comes before and after.
    a, b : float
        Where the left one ends and where the right one begins; `middle` begins at `a`.
    middle : Spline
        Meets both with value and two derivatives.

    Returns
    -------
    Spline
        With simple knots at the seams. Controls whose whole support lies before `a` are the same numbers.
    """
    end = middle.domain[1]
    span = 1e-9 * (end - a)
    head = left.knots[left.knots < a - span]
    tail = right.knots[right.knots > b + span] + (end - b)
    head = head if len(head) else np.repeat(a, 3)
    tail = tail if len(tail) else np.repeat(end, 3)
    knots = np.concatenate([head, middle.knots[3:-3], tail])
    controls = _blossoms(knots, left, a, middle, right, b)
    same = max(len(head) - 4, 0) if len(head) > 3 else 0
    controls[:same] = left.controls[:same]
    same = len(tail) - 4
    if same > 0:
        controls[-same:] = right.controls[-same:]
    return Spline(knots, controls)


def _blossoms(
    knots: FloatArray, left: Spline, a: float, middle: Spline, right: Spline, b: float
) -> FloatArray:
    # the blossom of the polynomial on any span of a control's support is the control itself: take the widest
    end = middle.domain[1]
    j = np.arange(len(knots) - 4)
    at = j + np.argmax(np.stack([knots[j + i + 1] - knots[j + i] for i in range(4)]), axis=0)
    mid = 0.5 * (knots[at] + knots[at + 1])
    values = np.zeros((4, len(j), middle.controls.shape[1]))
    for spline, here, shift in (
        (left, mid < a, 0.0),
        (middle, (mid >= a) & (mid <= end), 0.0),
        (right, mid > end, b - end),
    ):
        for i in range(4):
            values[i, here] = spline(mid[here] + shift, derivative=i)
    x, y, z = (knots[j + i] - mid for i in (1, 2, 3))
    s1, s2, s3 = (x + y + z) / 3, (x * y + y * z + z * x) / 3, x * y * z
    p, d1, d2, d3 = values
    return p + s1[:, None] * d1 + s2[:, None] * d2 / 2 + s3[:, None] * d3 / 6


def join_maps(before: MonotoneMap, a: float, length: float, after: MonotoneMap, b: float) -> MonotoneMap:
    """Let a clock run up to a place, then over `length` into another place, then on.

    Parameters
    ----------
    before, after : MonotoneMap
        The clocks; often the same one.
    a, b : float
        Where the first stops and where the second begins.
    length : float
        Of the piece between, on the side of the keys.

    Returns
    -------
    MonotoneMap
        Its speed has no jump. The piece between rises by its length times the mean of both speeds, but at
        least by a quarter of what the clock rises on average: where it stands still it would else stay still.
    """
    slopes = np.array([before(a, derivative=1), after(b, derivative=1)])
    keys, values = after.keys, after.values
    mean = (values[-1] - values[0]) / (keys[-1] - keys[0])
    rise = length * max(float(slopes.mean()), 0.25 * mean)
    low, high = float(before(a)), float(after(b))
    near = 1e-9 * (keys[-1] - keys[0])
    head, tail = before.keys < a - near, keys > b + near
    return MonotoneMap(
        np.concatenate([before.keys[head], [a, a + length], keys[tail] + (a + length - b)]),
        np.concatenate([before.values[head], [low, low + rise], values[tail] + (low + rise - high)]),
        np.concatenate([before.slopes[head], slopes, after.slopes[tail]]),
    )
