"""Clocks of a clip put together from pieces: beats to ticks, ticks to the parameter of the curve."""

from __future__ import annotations

import numpy as np

from tempose.curves import MonotoneMap, Seam, join_maps

Piece = tuple[float, float]

_CREEP = 1e-3


def splice_map(
    clock: MonotoneMap, pieces: list[Piece], seams: list[Seam]
) -> tuple[MonotoneMap, list[Piece], list[Seam]]:
    """Cut a clock into pieces and put them one after another.

    Parameters
    ----------
    clock : MonotoneMap
        One clock to the one below it.
    pieces : list of (start, stop)
        On this clock; a stop before the start runs backwards.
    seams : list of Seam
        Between the pieces, and round the end where closed; lengths on this clock.

    Returns
    -------
    MonotoneMap
        The clock, from 0; its pieces are exactly what they were, beyond one unit from the seams.
    list of (start, stop)
        The pieces on the clock below; none if all of it holds one pose.
    list of Seam
        The seams there.
    """
    parts = [_cut(clock, *piece) for piece in pieces]
    below = [(float(clock(a)), float(clock(b))) for a, b in pieces]
    if all(a == b == below[0][0] for a, b in below):
        return join_maps(parts), [], []
    parts, below, seams = _without_stills(parts, below, seams)
    laid: list[MonotoneMap] = []
    seams_below: list[Seam] = []
    for i, part in enumerate(parts):
        laid.append(part)
        if i < len(seams):
            seam, gap = _below(seams[i], part, parts[(i + 1) % len(parts)])
            seams_below.append(seam)
            laid += [gap] if gap is not None else []
    joined = join_maps(laid)
    return joined.shifted(-joined.keys[0], -joined.values[0]), below, seams_below


def _without_stills(
    parts: list[MonotoneMap], below: list[Piece], seams: list[Seam]
) -> tuple[list[MonotoneMap], list[Piece], list[Seam]]:
    # a piece in which the clock stands has no length below. Where the clip goes on from that very place it
    # becomes part of its neighbour; else it creeps, for a curve cannot stop
    parts, below, seams = list(parts), list(below), list(seams)
    i = 0
    while i < len(parts):
        a, b = below[i]
        after = i < min(len(seams), len(parts) - 1) and not seams[i].gap and below[i + 1][0] == a
        before = i > 0 and not seams[i - 1].gap and below[i - 1][1] == a
        if a != b or not (after or before):
            if a == b:
                below[i], parts[i] = _creeping(a, parts[i])
            i += 1
            continue
        j = i if after else i - 1
        parts[j : j + 2] = [join_maps(parts[j : j + 2])]
        below[j : j + 2] = [(below[j][0], below[j + 1][1])]
        del seams[j]
        i = max(j, 0)
    return parts, below, seams


def _creeping(at: float, part: MonotoneMap) -> tuple[Piece, MonotoneMap]:
    length = part.keys[-1] - part.keys[0]
    stop = at + _CREEP if at < 1 else at - _CREEP
    rise = np.array([0.0, _CREEP])
    ends = np.array([part.keys[0], part.keys[-1]])
    return (at, stop), MonotoneMap(ends, rise, np.full(2, _CREEP / length))


def _cut(clock: MonotoneMap, a: float, b: float) -> MonotoneMap:
    low, high = min(a, b), max(a, b)
    part = clock.slice(low, high).with_keys(np.array([low + 1, high - 1]))
    return part if a < b else part.reversed()


def _below(seam: Seam, left: MonotoneMap, right: MonotoneMap) -> tuple[Seam, MonotoneMap | None]:
    # what a length on this clock is on the one below: by the paces beside the seam
    pace = 0.5 * (_pace(left, left.keys[-1], seam) + _pace(right, right.keys[0], seam))
    if seam.gap <= 0:
        return Seam(seam.half_life * pace, 0.0, seam.fade * pace), None
    slopes = np.array([left.slopes[-1], right.slopes[0]])
    length = max(seam.gap * slopes.mean(), 0.1 * seam.gap * pace)
    gap = MonotoneMap(np.array([0.0, seam.gap]), np.array([0.0, length]), slopes)
    return Seam(seam.half_life * pace, length, 0.0), gap.with_keys(np.arange(1.0, seam.gap))


def _pace(part: MonotoneMap, at: float, seam: Seam) -> float:
    reach = np.clip([at - seam.half_life, at + seam.half_life], *part.domain)
    whole = (part.values[-1] - part.values[0]) / (part.keys[-1] - part.keys[0])
    near = (part(reach[1]) - part(reach[0])) / (reach[1] - reach[0])
    return float(max(near, 0.1 * whole)) or 1.0
