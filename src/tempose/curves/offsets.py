"""Offsets that fade away: what carries a jump between two curves so that they meet smoothly.

An offset is a function of the distance q >= 0 from the seam; it returns values and three derivatives,
(4, N, c).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from tempose.curves.spline import Spline
from tempose.typing import FloatArray

Offset: TypeAlias = Callable[[FloatArray], FloatArray]

_HALVED = 2.6740603137235603  # (1 + x + x^2 / 2) exp(-x) = 1/2


def damped_offset(state: FloatArray, half_life: float, reach: float) -> Offset:
    """Return a critically damped offset, cut off smoothly.

    Parameters
    ----------
    state : (3, c) float
        Its value, velocity and acceleration at q = 0.
    half_life : float
        Where a resting offset has fallen to one half.
    reach : float
        Where it has become exactly 0, with two derivatives.

    Returns
    -------
    callable
        ``exp(-k q) (x_0 + c_1 q + c_2 q^2)`` times a window of degree 5: three poles let it start with any
        acceleration.
    """
    k = _HALVED / half_life
    x, v, a = state
    c = np.stack([x, v + k * x, 0.5 * (a + 2 * k * v + k * k * x)])

    def offset(q: FloatArray) -> FloatArray:
        q = np.minimum(q, reach)
        rows = [c]
        for _ in range(3):  # the derivative of exp(-k q) p(q) is exp(-k q) (p' - k p)
            p = rows[-1]
            rows.append(np.stack([p[1] - k * p[0], 2 * p[2] - k * p[1], -k * p[2]]))
        powers = np.stack([np.ones_like(q), q, q * q], axis=1) * np.exp(-k * q)[:, None]
        return _product(window(q, reach)[..., None], np.stack([powers @ p for p in rows]))

    return offset


def window(q: FloatArray, reach: float) -> FloatArray:
    """Return the quintic that falls from 1 at 0 to 0 at `reach`, and its derivatives.

    Parameters
    ----------
    q : (N,) float
        Places.
    reach : float
        Where it ends.

    Returns
    -------
    (4, N) ndarray
        Values and derivatives of order 1 to 3; flat to second order at both ends.
    """
    s = np.clip(q / reach, 0.0, 1.0)
    inside = (q >= 0) & (q < reach)
    return np.stack(
        [
            1 - s**3 * (10 - 15 * s + 6 * s**2),
            -30 * (s * (1 - s)) ** 2 / reach,
            -60 * s * (1 - s) * (1 - 2 * s) / reach**2,
            np.where(inside, -60 * (1 - 6 * s + 6 * s**2), 0.0) / reach**3,
        ]
    )


def faded_offset(difference: Offset, reach: float, weight: float = 0.5) -> Offset:
    """Return the share of a crossfade on one side of the seam.

    Parameters
    ----------
    difference : callable
        What the other curve has more than this one, q away from the seam.
    reach : float
        Half the length of the crossfade.
    weight : float, default 0.5
        Share of the other curve at the seam.

    Returns
    -------
    callable
        The offset.
    """

    def offset(q: FloatArray) -> FloatArray:
        share = weight * window(q + reach, 2 * reach) / 0.5
        return _product(share[..., None], difference(np.minimum(q, reach)))

    return offset


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.stack(
        [
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            a[2] * b[0] + 2 * a[1] * b[1] + a[0] * b[2],
            a[3] * b[0] + 3 * a[2] * b[1] + 3 * a[1] * b[2] + a[0] * b[3],
        ]
    )


def carried(spline: Spline, offset: Offset, *, at_end: bool) -> Spline:
    """Return a curve with an offset added at one of its ends.

    Parameters
    ----------
    spline : Spline
        The curve.
    offset : callable
        The offset.
    at_end : bool
        Whether q runs backwards from the end, or forwards from the start.

    Returns
    -------
    Spline
        Over the same knots: value, velocity and acceleration at that end are exactly those asked for,
        between the knots the offset is followed as well as a cubic can. Controls beyond the reach are the
        same bit for bit.
    """
    knots, k = spline.knots, len(spline.controls)
    triples = np.stack([knots[1 : k + 1], knots[2 : k + 2], knots[3 : k + 3]], axis=1)
    end = spline.domain[1] if at_end else spline.domain[0]
    touches = (triples == end).any(axis=1)
    middle = np.where(touches, end, triples[:, 1])
    sign = -1.0 if at_end else 1.0
    values = offset(sign * (middle - end))
    a, b, c = (triples - middle[:, None]).T * sign
    # de Boor and Fix: the blossom of the Taylor polynomial at the middle knot
    s1, s2, s3 = (a + b + c) / 3, (a * b + b * c + c * a) / 3, a * b * c
    terms = values[0] + s1[:, None] * values[1] + s2[:, None] * values[2] / 2 + s3[:, None] * values[3] / 6
    return spline.with_controls(spline.controls + terms)
