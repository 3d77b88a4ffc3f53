"""Frames of what is played, as edits name them, checked and turned into seconds."""

from __future__ import annotations

import math
from typing import Any

from tempose.signals.signals import Signals

MOST_FRAMES = 1_000_000
"""What an edit may play at most, nine hours at 30 a second: a slip of the pen must not fill the memory."""


def frame_seconds(signals: Signals, frame: Any, name: str) -> float:
    """Return when a frame is played.

    Parameters
    ----------
    signals : Signals
        What is played.
    frame : float
        Frame from 0; a fraction lies between two.
    name : str
        Name of the argument, for the message.

    Returns
    -------
    float
        Seconds.

    Raises
    ------
    ValueError
        If there is no such frame.
    """
    last = signals.duration * signals.fps
    if isinstance(frame, bool) or not isinstance(frame, int | float) or not math.isfinite(frame):
        raise ValueError(f"{name} must be a frame from 0 to {last:.6g}, got {frame!r}")
    if not -1e-9 <= frame <= last + 1e-6:
        raise ValueError(f"{name} must be a frame from 0 to {last:.6g}, got {frame:.6g}")
    return min(max(frame / signals.fps, 0.0), signals.duration)


def frame_span(signals: Signals, start: Any, stop: Any) -> tuple[float, float]:
    """Return when a part of what is played begins and ends.

    Parameters
    ----------
    signals : Signals
        What is played.
    start, stop : float
        Frames from 0, `stop` after `start`.

    Returns
    -------
    tuple of float
        Seconds.

    Raises
    ------
    ValueError
        If there are no such frames, or nothing lies between them.
    """
    a, b = frame_seconds(signals, start, "from"), frame_seconds(signals, stop, "to")
    if not b - a > 1e-9 * signals.duration:
        raise ValueError(f"to must be a frame after from = {start:.6g}, got {stop:.6g}")
    return a, b


def check_length(frames: float, name: str, value: float) -> None:
    """Refuse an edit that would play more frames than anyone means.

    Parameters
    ----------
    frames : float
        How many would be played.
    name : str
        Name of the argument that makes them so many, for the message.
    value : float
        What it is.

    Raises
    ------
    ValueError
        If they are more than `MOST_FRAMES`.
    """
    if not frames <= MOST_FRAMES:
        raise ValueError(
            f"{name} = {value:.6g} would make {frames:.6g} frames, expected at most {MOST_FRAMES} in all"
        )
