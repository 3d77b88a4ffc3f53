"""Pieces of a clip put one after another: what every cut, loop, paste, reversal and blend is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tempose.curves import MonotoneMap, Seam, splice_spline
from tempose.signals.placement import splice_placement
from tempose.signals.signals import Signals
from tempose.signals.time.clocks import splice_map
from tempose.signals.time.origin import splice_origin
from tempose.signals.time.signal import TimeSignal

Piece = tuple[float, float]


@dataclass(frozen=True)
class Join:
    """How two pieces meet, in frames of what is played."""

    half_life: float = 3.0
    """A jump is carried by damped offsets that halve in this many frames, half of it on either side..."""
    insert: int = 0
    """...or this many new frames are put between the two, and no other frame changes..."""
    fade: float = 0.0
    """...or over this many frames both are played and crossfaded, where the clip goes on long enough."""
    apart: bool = False
    """Whether the two ends are a frame apart instead of one moment, whatever is inserted."""


def splice(
    signals: Signals,
    pieces: Sequence[Piece],
    joins: Join | Sequence[Join] | None = None,
    *,
    closed: bool = False,
) -> Signals:
    """Return pieces of a clip one after another.

    Parameters
    ----------
    signals : Signals
        The clip.
    pieces : sequence of (start, stop)
        In seconds of what is played; a stop before the start runs backwards. The last instant of a piece is
        the first of the next one.
    joins : Join or sequence of Join, optional
        One for all seams, or one for each; the default carries jumps by damped offsets.
    closed : bool, default False
        Whether the end shall meet the start, too, so that the clip can be played round and round; inserted
        frames stand at the end.

    Returns
    -------
    Signals
        C2 at the seams in curve and path; frames beyond their reach (8 half-lives) are the same.

    Raises
    ------
    ValueError
        If there is no piece, one is empty or leaves the clip, or the number of joins does not fit.

    Notes
    -----
    Every clock map is cut exactly (a cubic by Hermite subdivision); where the pace differs at a seam the
    slower one holds there, and the maps change from one beat before to one beat after.
    """
    pieces, joins = _checked(signals, pieces, joins, closed)
    beats = [(a * signals.rate, b * signals.rate) for a, b in pieces]
    beats_a_frame = signals.rate / signals.fps
    seams = [
        Seam(
            j.half_life * beats_a_frame,
            (j.insert + 1) * beats_a_frame * (j.insert > 0 or j.apart),
            j.fade * beats_a_frame,
        )
        for j in joins
    ]
    retimings: list[MonotoneMap] = []
    for retiming in signals.retimings:
        cut, below, seams_below = splice_map(retiming, beats, seams)
        retimings.append(cut)
        if not below:  # all of it holds one pose: what lies below stays whole
            return replace(signals, retimings=(*retimings, *signals.retimings[len(retimings) :]))
        beats, seams = below, seams_below
    return replace(_splice_ticks(signals, beats, seams, closed), retimings=tuple(retimings))


def _checked(
    signals: Signals, pieces: Sequence[Piece], joins: Join | Sequence[Join] | None, closed: bool
) -> tuple[list[Piece], list[Join]]:
    room = 1e-9 * signals.duration
    for a, b in pieces:
        if not (-room <= min(a, b) and max(a, b) <= signals.duration + room and abs(a - b) > room):
            raise ValueError(
                f"a piece must have a length and lie in 0 .. {signals.duration:.6g} s, got {a:.6g} .. {b:.6g}"
            )
    if not pieces:
        raise ValueError("splicing needs one piece or more")
    wanted = len(pieces) - (0 if closed else 1)
    if joins is None or isinstance(joins, Join):
        joins = [joins or Join()] * wanted
    if len(joins) != wanted:
        raise ValueError(f"{len(pieces)} pieces meet at {wanted} seams, got {len(joins)} joins")
    return _merged([(float(a), float(b)) for a, b in pieces], list(joins), room)


def _merged(pieces: list[Piece], joins: list[Join], room: float) -> tuple[list[Piece], list[Join]]:
    # pieces that go straight on are one: nothing is cut, nothing changes
    out, kept = [pieces[0]], list[Join]()
    for i, (a, b) in enumerate(pieces[1:]):
        before = out[-1]
        goes_on = abs(before[1] - a) <= room and (before[1] > before[0]) == (b > a)
        if goes_on and not joins[i].insert and not joins[i].apart:
            out[-1] = (before[0], b)
        else:
            kept.append(joins[i])
            out.append((a, b))
    return out, kept + joins[len(pieces) - 1 :]


def _splice_ticks(signals: Signals, pieces: list[Piece], seams: list[Seam], closed: bool) -> Signals:
    pace, along, seams_along = splice_map(signals.time.pace, pieces, seams)
    time = TimeSignal(
        splice_spline(signals.time.curve, along, seams_along, closed=closed),
        splice_spline(signals.time.unedited, along, seams_along, closed=closed),
        pace,
    )
    path = None if signals.path is None else splice_spline(signals.path, pieces, seams, closed=closed)
    placement = None
    if signals.placement is not None:
        placement = splice_placement(signals.placement, pieces, seams, closed=closed)
    origin = splice_origin(signals.origin, pieces, [seam.gap for seam in seams])
    return replace(signals, time=time, path=path, placement=placement, origin=origin)
