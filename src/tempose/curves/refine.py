"""Exact rewritings of a spline: more knots, a piece of it.

A control point of a cubic B-spline is the blossom (polar form) of the curve at three knots in a row, so every
rewriting that keeps the old knots is one evaluation of the blossom.

References
----------
.. [1] Ramshaw, "Blossoms are polar forms", Computer Aided Geometric Design 6, 1989.
"""

from __future__ import annotations

import numpy as np

from tempose.curves._kernels import span_of
from tempose.curves.spline import Spline
from tempose.typing import FloatArray, IntArray


def insert_knots(spline: Spline, at: FloatArray) -> Spline:
    """Return the same curve with more knots.

    Parameters
    ----------
    spline : Spline
        The curve.
    at : (N,) float
        New knots, inside the domain; no knot may end up more than fourfold.

    Returns
    -------
    Spline
        N more controls; those whose three knots stay neighbours are the same bit for bit.

    Raises
    ------
    ValueError
        If a knot lies outside the domain.
    """
    at = np.atleast_1d(np.asarray(at, dtype=np.float64))
    first, last = spline.domain
    if at.size and not (first < at.min() and at.max() < last):
        raise ValueError(f"new knots must lie inside {first:.6g} .. {last:.6g}, got {at}")
    return _rewritten(spline, np.sort(np.concatenate([spline.knots, at])))


def slice_spline(spline: Spline, start: float, stop: float) -> Spline:
    """Return a piece of a curve, exactly.

    Parameters
    ----------
    spline : Spline
        The curve.
    start, stop : float
        Where the piece begins and ends, ``start < stop``, inside the domain.

    Returns
    -------
    Spline
        The piece over ``start .. stop``.

    Raises
    ------
    ValueError
        If the piece is empty or leaves the domain.
    """
    first, last = spline.domain
    room = 1e-9 * (last - first)
    if not (first - room <= start < stop <= last + room):
        raise ValueError(f"a piece must lie in {first:.6g} .. {last:.6g}, got {start:.6g} .. {stop:.6g}")
    knots = spline.knots
    # knots that all but touch an end would leave a sliver of a span that nothing can be solved on
    inner = knots[(knots > start + room) & (knots < stop - room)]
    start, stop = max(start, first), min(stop, last)
    return _rewritten(spline, np.concatenate([[start] * 4, inner, [stop] * 4]))


def _rewritten(spline: Spline, knots: FloatArray) -> Spline:
    k = len(knots) - 4
    triples = np.stack([knots[1 : k + 1], knots[2 : k + 2], knots[3 : k + 3]], axis=1)
    controls = np.zeros((k, spline.controls.shape[1]))
    same = _same_control(spline.knots, triples)
    controls[same >= 0] = spline.controls[same[same >= 0]]
    new = np.flatnonzero(same < 0)
    if len(new):
        spans = np.array([_span(spline.knots, knots[j : j + 5]) for j in new])
        controls[new] = blossom(spline, triples[new], spans)
    return Spline(knots, controls)


def _same_control(knots: FloatArray, triples: FloatArray) -> IntArray:
    # where the three knots already stand in a row the control is copied: not one bit changes
    k = len(knots) - 4
    found = np.full(len(triples), -1)
    for j in (
        np.searchsorted(knots, triples[:, 0], "left"),
        np.searchsorted(knots, triples[:, 2], "right") - 3,
    ):
        inside = (j >= 1) & (j <= k)
        rows = np.clip(j, 1, k)[:, None] + np.arange(3)
        equal = inside & (knots[rows] == triples).all(axis=1)
        found[equal] = j[equal] - 1
    return found


def _span(knots: FloatArray, support: FloatArray) -> int:
    widths = np.diff(support)
    i = int(np.argmax(widths))
    middle = 0.5 * (support[i] + support[i + 1])
    return int(span_of(knots, min(max(middle, knots[3]), knots[-4])))


def blossom(spline: Spline, triples: FloatArray, spans: IntArray) -> FloatArray:
    """Return the polar form of pieces of a curve.

    Parameters
    ----------
    spline : Spline
        The curve.
    triples : (N, 3) float
        Arguments, in any order.
    spans : (N,) int
        The polynomial meant: that of ``knots[i] .. knots[i + 1]``.

    Returns
    -------
    (N, c) ndarray
        Values; with all three arguments the same, the polynomial itself.
    """
    knots = spline.knots
    d = spline.controls[spans[:, None] + np.arange(-3, 1)].copy()
    for level in range(1, 4):
        for r in range(3, level - 1, -1):
            low, high = knots[spans - 3 + r], knots[spans + r + 1 - level]
            share = ((triples[:, level - 1] - low) / (high - low))[:, None]
            d[:, r] = (1 - share) * d[:, r - 1] + share * d[:, r]
    return d[:, 3]
