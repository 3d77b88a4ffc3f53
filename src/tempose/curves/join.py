"""Pieces put one after another: splines that meet smoothly, monotone maps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.curves.monotone import MonotoneMap
from tempose.curves.refine import insert_knots
from tempose.curves.spline import Spline
from tempose.typing import FloatArray

_LEAST_INNER = 3  # so that the controls at the two ends of a piece are different ones


def join_splines(pieces: Sequence[Spline]) -> Spline:
    """Return the curve that runs through pieces one after another, each shifted to where the last ends.

    Parameters
    ----------
    pieces : sequence of Spline
        Where one ends the next must have the same value, velocity and acceleration (see `carried`).

    Returns
    -------
    Spline
        C2: a seam is one simple knot. Every control whose three knots lie in one piece is copied; one a seam
        is new, and it is determined: removing the other knots of the seam changes nothing.
    """
    placed: list[Spline] = []
    for piece in pieces:
        piece = with_inner_knots(piece, _LEAST_INNER)
        end = placed[-1].domain[1] if placed else piece.domain[0]
        placed.append(piece.shifted(end - piece.domain[0]))
    knots, controls = [placed[0].knots[:4]], [placed[0].controls[:2]]
    for i, piece in enumerate(placed):
        if i:
            seam = placed[i - 1].domain[1]
            knots.append(np.array([seam]))
            controls.append(_across(placed[i - 1], piece, seam)[None])
        knots.append(piece.knots[4:-4])
        controls.append(piece.controls[2:-2])
    knots.append(placed[-1].knots[-4:])
    controls.append(placed[-1].controls[-2:])
    return Spline(np.concatenate(knots), np.concatenate(controls))


def _across(left: Spline, right: Spline, seam: float) -> FloatArray:
    # the control of (last inner knot, seam, first inner knot), extrapolated from both sides: with equal
    # second derivatives the two agree, and the shorter way is the less noisy
    u2, u1 = seam - left.knots[-6], seam - left.knots[-5]
    v1, v2 = right.knots[4] - seam, right.knots[5] - seam
    from_left = left.controls[-2] + (left.controls[-2] - left.controls[-3]) * (v1 / u2)
    from_right = right.controls[1] + (right.controls[1] - right.controls[2]) * (u1 / v2)
    share = (u1 / v2) / (u1 / v2 + v1 / u2)
    return share * from_left + (1 - share) * from_right


def with_inner_knots(spline: Spline, least: int) -> Spline:
    """Return the same curve with knots in its widest spans until there are enough.

    Parameters
    ----------
    spline : Spline
        The curve.
    least : int
        How many knots it shall have inside its domain.

    Returns
    -------
    Spline
        The curve.
    """
    missing = least - (len(spline.controls) - 4)
    breaks = spline.breaks
    for _ in range(missing):
        i = int(np.argmax(np.diff(breaks)))
        breaks = np.insert(breaks, i + 1, 0.5 * (breaks[i] + breaks[i + 1]))
    return insert_knots(spline, np.setdiff1d(breaks, spline.breaks)) if missing > 0 else spline


def join_maps(pieces: Sequence[MonotoneMap]) -> MonotoneMap:
    """Return the map that runs through pieces one after another, each going on where the last ended.

    Parameters
    ----------
    pieces : sequence of MonotoneMap
        The pieces.

    Returns
    -------
    MonotoneMap
        Where the slopes of two pieces differ the lesser is taken for both: that keeps every piece monotone,
        and changes nothing beyond the nearest key.
    """
    keys, values, slopes = (list[FloatArray]() for _ in range(3))
    for i, piece in enumerate(pieces):
        if not i:
            keys, values, slopes = [piece.keys], [piece.values], [piece.slopes.copy()]
            continue
        placed = piece.shifted(keys[-1][-1] - piece.keys[0], values[-1][-1] - piece.values[0])
        slopes[-1][-1] = min(slopes[-1][-1], piece.slopes[0])
        keys.append(placed.keys[1:])
        values.append(placed.values[1:])
        slopes.append(placed.slopes[1:].copy())
    values_joined = np.maximum.accumulate(np.concatenate(values))
    return MonotoneMap(np.concatenate(keys), values_joined, np.concatenate(slopes))
