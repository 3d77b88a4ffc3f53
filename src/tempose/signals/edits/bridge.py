"""New frames between two moments: a loop drawn by hand, or one place running over into another."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tempose._validate import as_floats
from tempose.curves import MonotoneMap, Spline
from tempose.signals.edits._frames import check_length, frame_seconds
from tempose.signals.edits.seams import derivatives, join_maps, join_splines, middle_spline
from tempose.signals.placement import ground_motions
from tempose.signals.signals import Signals
from tempose.signals.time.origin import Origin
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


def insert_curve(
    signals: Signals, at: float, points: Sequence[Sequence[float]] | FloatArray, frames: float
) -> Signals:
    """Leave the curve at a frame, run through drawn points and come back (Fig. 5 of the paper).

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    at : float
        Frame from 0.
    points : (N, 2) float
        Places of the pose plane to run through, N >= 1.
    frames : float
        How many frames this takes; what came after `at` comes later by so many.

    Returns
    -------
    Signals
        Smooth where the new piece begins and ends; frames away from it are what they were.

    Raises
    ------
    ValueError
        If there is no such frame, no point, or `frames` is not 1 or more.
    """
    points = as_floats(points, "points", ("N", 2))
    if len(points) == 0:
        raise ValueError("points must hold 1 or more places of the pose plane, got none")
    seconds = frame_seconds(signals, at, "at")
    return _bridged(signals, seconds, seconds, points, frames)


def blend(signals: Signals, start: float, stop: float, frames: float) -> Signals:
    """Let a place of the curve run over into another one.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start : float
        Frame from 0 up to which is played.
    stop : float
        Frame from which is played on; also an earlier one.
    frames : float
        Frames of the new piece between them.

    Returns
    -------
    Signals
        Smooth at both frames; away from them frames are what they were.

    Raises
    ------
    ValueError
        If there are no such frames or `frames` is not 1 or more.
    """
    a, b = frame_seconds(signals, start, "from"), frame_seconds(signals, stop, "to")
    return _bridged(signals, a, b, np.zeros((0, 2)), frames)


@dataclass(frozen=True)
class _Gap:
    """Where on one clock the old part ends, the new piece ends, and the next old part begins."""

    a: float
    end: float
    b: float


def _bridged(signals: Signals, a: float, b: float, points: FloatArray, frames: float) -> Signals:
    if isinstance(frames, bool) or not 1 <= frames < math.inf:
        raise ValueError(f"frames must be 1 or more, got {frames!r}")
    check_length(signals.duration * signals.fps + frames, "frames", frames)
    beats = frames / signals.fps * signals.rate
    gap = _Gap(a * signals.rate, a * signals.rate + beats, b * signals.rate)
    retimings: list[MonotoneMap] = []
    for old in signals.retimings:
        new, gap = _bridged_map(old, gap)
        retimings.append(new)
    pace, u = _bridged_map(signals.time.pace, gap)
    time = TimeSignal(
        _bridged_curve(signals.time.curve, u, points), _bridged_curve(signals.time.unedited, u, points), pace
    )
    return replace(
        signals,
        time=time,
        retimings=tuple(retimings),
        path=_bridged_path(signals, gap, time if len(points) else None),
        placement=_bridged_placement(signals.placement, gap),
        origin=_bridged_origin(signals.origin, gap),
    )


def _bridged_map(old: MonotoneMap, gap: _Gap) -> tuple[MonotoneMap, _Gap]:
    new = join_maps(old, gap.a, gap.end - gap.a, old, gap.b)
    return new, _Gap(float(old(gap.a)), float(new(gap.end)), float(old(gap.b)))


def _bridged_curve(curve: Spline, gap: _Gap, points: FloatArray) -> Spline:
    before, after = derivatives(curve, gap.a), derivatives(curve, gap.b)
    steps = np.sqrt(np.linalg.norm(np.diff(np.concatenate([before[:1], points, after[:1]]), axis=0), axis=1))
    steps = np.maximum(steps, 1e-3 * max(steps.mean(), 1e-300))
    u = gap.a + (gap.end - gap.a) * np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])
    u[-1] = gap.end
    return join_splines(curve, gap.a, middle_spline(u, before, after, points), curve, gap.b)


def _bridged_path(signals: Signals, gap: _Gap, drawn: TimeSignal | None) -> Spline | None:
    if signals.path is None:
        return None
    if drawn is None:
        # straight through the shapes: the poses of the plane between two far places are none of this motion
        ends = signals.path(gap.a), signals.path(gap.b)
        return _bridged_spline(signals.path, signals.path, gap, lambda t, s: (1 - s) * ends[0] + s * ends[1])
    captured = [_captured(signals, t) for t in (gap.a, gap.b)]
    ends = [signals.time.before_edits(np.array(t)) for t in (gap.a, gap.b)]
    offsets = [signals.path(t) - signals.pose(p, c) for t, p, c in zip((gap.a, gap.b), ends, captured)]

    def values(t: FloatArray, s: FloatArray) -> FloatArray:
        p = drawn.before_edits(t)
        # of a pose signal made of windows each end has its own; without windows both are the same
        x = (1 - s) * signals.pose(p, np.full(len(t), captured[0]))
        x = x + s * signals.pose(p, np.full(len(t), captured[1]))
        # what the path knows beyond g belongs to the poses at the ends, not to those drawn far from them
        near = [signals.share_of_path(np.linalg.norm(p - end, axis=1))[:, None] for end in ends]
        return x + (1 - s) * near[0] * offsets[0] + s * near[1] * offsets[1]

    return _bridged_spline(signals.path, signals.path, gap, values)


def _captured(signals: Signals, tick: float) -> FloatArray:
    at = np.array(tick)
    return at if signals.origin is None else signals.origin(at)


def _bridged_spline(
    left: Spline, right: Spline, gap: _Gap, values: Callable[[FloatArray, FloatArray], FloatArray]
) -> Spline:
    """Bridge splines over ticks by values a tick apart, asked with ticks and how far along they are."""
    t = np.linspace(gap.a, gap.end, max(math.ceil(gap.end - gap.a - 1e-9), 1) + 1)
    s = ((t - gap.a) / (gap.end - gap.a))[1:-1, None]
    inner = values(t[1:-1], s * s * (3 - 2 * s))
    middle = middle_spline(t, derivatives(left, gap.a), derivatives(right, gap.b), inner)
    return join_splines(left, gap.a, middle, right, gap.b)


def _bridged_placement(placement: Spline | None, gap: _Gap) -> Spline | None:
    if placement is None:
        return None
    first, last = placement.domain
    moved = ground_motions(placement, [(first, gap.a), (gap.b, last)])[1]
    right = Spline(placement.knots, moved(placement.controls))
    # the body goes on as fast as it was and will be, else a walker would step on the spot
    speed = 0.5 * (placement(gap.a, derivative=1) + right(gap.b, derivative=1))
    advance = np.concatenate([np.zeros(4), speed[4:] * [1.0, 0.0, 1.0]]) * (gap.end - gap.a)
    right = Spline(right.knots, right.controls + advance)
    ends = placement(gap.a), right(gap.b)
    return _bridged_spline(placement, right, gap, lambda t, s: (1 - s) * ends[0] + s * ends[1])


def _bridged_origin(origin: Origin | None, gap: _Gap) -> Origin:
    old = origin or Origin(np.zeros(1), np.zeros(1), np.ones(1))
    head, tail = old.starts < gap.a, old.starts > gap.b
    at = np.array([gap.a, gap.b])
    direction = old.directions[np.maximum(np.searchsorted(old.starts, at[1], side="right") - 1, 0)]
    # the new piece comes from no tick: it stands at the one where it leaves
    return Origin(
        np.concatenate([old.starts[head], [gap.a, gap.end], old.starts[tail] + (gap.end - gap.b)]),
        np.concatenate([old.sources[head], old(at), old.sources[tail]]),
        np.concatenate([old.directions[head], np.array([0.0, direction]), old.directions[tail]]),
    )
