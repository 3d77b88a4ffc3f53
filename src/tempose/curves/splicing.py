"""A spline spliced from pieces of itself, with the jumps at the seams carried away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tempose.curves.bridge import bridge
from tempose.curves.join import join_splines, with_inner_knots
from tempose.curves.offsets import Offset, carried, damped_offset, faded_offset
from tempose.curves.refine import slice_spline
from tempose.curves.spline import Spline
from tempose.typing import FloatArray

Piece = tuple[float, float]
"""Start and stop; a stop before the start runs backwards."""

REACH = 8.0
"""Half-lives after which a damped offset is exactly 0."""


@dataclass(frozen=True)
class Seam:
    """How two pieces meet, in units of the curve's parameter."""

    half_life: float = 3.0
    """A jump is carried by damped offsets of this half-life, one half on either side..."""
    gap: float = 0.0
    """...unless a bridge of this length is put between, and no piece changes..."""
    fade: float = 0.0
    """...or both pieces are played on for half this length beyond the seam, and crossfaded."""


class Motion(Protocol):
    """An affine map of the points of a curve."""

    def __call__(self, points: FloatArray, /) -> FloatArray:
        """Map points (..., c)."""
        ...

    def back(self, changes: FloatArray, /) -> FloatArray:
        """Map differences of mapped points (..., c) back."""
        ...


def splice_spline(
    spline: Spline,
    pieces: Sequence[Piece],
    seams: Sequence[Seam],
    *,
    closed: bool = False,
    motions: Sequence[Motion] | None = None,
) -> Spline:
    """Return pieces of a curve one after another, C2.

    Parameters
    ----------
    spline : Spline
        The curve.
    pieces : sequence of (start, stop)
        In units of its parameter; no length may be 0.
    seams : sequence of Seam
        One between any two pieces, and one more from the last to the first where closed.
    closed : bool, default False
        Whether the end shall meet the start, too.
    motions : sequence of Motion, optional
        Where each piece is moved, the first by nothing; where closed one more: what moves the first piece to
        where the last one ends.

    Returns
    -------
    Spline
        From 0; the curve beyond the reach of the seams is the same to rounding.
    """
    n = len(pieces)
    whole = [spline] * (n + 1)
    if motions is not None:  # where closed the last one is the first piece anew
        whole = [spline, *(spline.with_controls(motion(spline.controls)) for motion in motions[1:])]
    parts = [with_inner_knots(_piece(curve, piece), 3) for curve, piece in zip(whole, pieces)]
    out = list(parts)
    bridges: dict[int, Spline] = {}
    for i in range(n if closed else n - 1):
        j, seam = (i + 1) % n, seams[i]
        left, right = _state(whole[i], pieces[i], 1), _state(whole[i + 1], pieces[j], 0)
        if seam.gap > 0:
            bridges[i] = bridge(left, right, seam.gap)
            continue
        towards = _offsets((whole[i], pieces[i]), (whole[i + 1], pieces[j]), left, right, seam)
        if towards is not None:
            out[i] = carried(out[i], towards[0], at_end=True)
            out[j] = carried(out[j], towards[1] if j else _moved_back(towards[1], motions), at_end=False)
    laid: list[Spline] = []
    for i, part in enumerate(out):
        laid.append(part)
        if i in bridges:
            laid.append(bridges[i])
    return join_splines([laid[0].shifted(-laid[0].domain[0]), *laid[1:]])


def _piece(spline: Spline, piece: Piece) -> Spline:
    part = slice_spline(spline, min(piece), max(piece))
    return part if piece[0] < piece[1] else part.reversed()


def _state(curve: Spline, piece: Piece, end: int) -> FloatArray:
    # of the curve the piece is cut from: beside a sliver of a span the piece's own derivatives are rounding
    way = 1.0 if piece[1] > piece[0] else -1.0
    return np.stack([way**order * curve(piece[end], order) for order in range(3)])


def _moved_back(offset: Offset, motions: Sequence[Motion] | None) -> Offset:
    if motions is None:
        return offset
    last = motions[-1]
    return lambda q: last.back(offset(q))


def _offsets(
    one: tuple[Spline, Piece], other: tuple[Spline, Piece], left: FloatArray, right: FloatArray, seam: Seam
) -> tuple[Offset, Offset] | None:
    (spline, before), (spline_after, after) = one, other
    jump = right - left
    if not jump.any():
        return None
    lengths = [abs(b - a) for a, b in (before, after)]
    if seam.fade > 0:
        half = min(0.5 * seam.fade, *lengths, _beyond(spline, before[1], before), _ahead(spline, after))
        if half > 1e-3 * seam.fade:
            return _crossfade((spline, before), (spline_after, after), half)
    backwards = np.array([1.0, -1.0, 1.0])[:, None]
    reaches = [min(REACH * seam.half_life, length) for length in lengths]
    return (
        damped_offset(0.5 * jump * backwards, seam.half_life, reaches[0]),
        damped_offset(-0.5 * jump, seam.half_life, reaches[1]),
    )


def _beyond(spline: Spline, end: float, piece: Piece) -> float:
    first, last = spline.domain
    return last - end if piece[1] > piece[0] else end - first


def _ahead(spline: Spline, piece: Piece) -> float:
    first, last = spline.domain
    return piece[0] - first if piece[1] > piece[0] else last - piece[0]


def _crossfade(one: tuple[Spline, Piece], other: tuple[Spline, Piece], half: float) -> tuple[Offset, Offset]:
    (spline, before), (spline_after, after) = one, other
    ways = [1.0 if b > a else -1.0 for a, b in (before, after)]

    def difference(sign: float) -> Offset:
        # along q away from the seam: the other curve's values minus this one's
        def of(q: FloatArray) -> FloatArray:
            rows: list[FloatArray] = []
            for order in range(4):
                last = spline(before[1] + ways[0] * sign * q, order) * (ways[0] * sign) ** order
                first = spline_after(after[0] + ways[1] * sign * q, order) * (ways[1] * sign) ** order
                rows.append(-sign * (first - last))
            return np.stack(rows)

        return of

    return faded_offset(difference(-1.0), half), faded_offset(difference(1.0), half)
