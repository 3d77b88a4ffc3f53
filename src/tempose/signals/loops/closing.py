"""A loop that plays round and round without a seam."""

from __future__ import annotations

import math

import numpy as np

from tempose.signals.signals import Signals
from tempose.signals.time.splice import Join, splice

HALF_LIFE = 3.0
_WIDE = 1.0  # steps: across a wider gap frames are inserted


def close_loop(
    signals: Signals, start: float, stop: float, insert: int | None = None, *, half_life: float = HALF_LIFE
) -> Signals:
    """Keep a part of a clip that, played again and again, has no seam.

    Parameters
    ----------
    signals : Signals
        The clip.
    start, stop : float
        Frames from 0: where the loop begins, and the frame that the first one then stands for.
    insert : int, optional
        Frames to insert between the end and the begin; no other frame then changes. 0 carries the jump by
        damped offsets at both ends. None inserts as many frames as the gap has steps, up to 4, if it is wider
        than one step, else none.
    half_life : float, default 3
        Frames in which the damped offsets halve.

    Returns
    -------
    Signals
        The loop, once; its last frame is its first one again.

    Raises
    ------
    ValueError
        If there are no such frames or `insert` is negative.
    """
    last = signals.duration * signals.fps
    if not (math.isfinite(start) and math.isfinite(stop) and 0 <= start < stop <= last + 1e-6):
        raise ValueError(f"a loop goes from a frame to a later one, 0 to {last:.6g}, got {start} to {stop}")
    a, b = start / signals.fps, min(stop / signals.fps, signals.duration)
    if insert is None:
        insert = _inserted(signals, a, b)
    if insert < 0:
        raise ValueError(f"insert must be 0 or more frames, got {insert}")
    return splice(signals, [(a, b)], Join(half_life=half_life, insert=insert), closed=True)


def _inserted(signals: Signals, a: float, b: float) -> int:
    x = signals.coordinates(np.concatenate([[b], np.arange(a, b, 1 / signals.fps)]))
    steps = np.linalg.norm(np.diff(x[1:], axis=0), axis=1)
    median = float(np.median(steps)) if len(steps) else 0.0
    gap = float(np.linalg.norm(x[1] - x[0]))
    return min(4, round(gap / median)) if gap > _WIDE * median > 0 else 0
