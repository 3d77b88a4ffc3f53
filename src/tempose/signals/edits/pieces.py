"""Edits that cut what is played into pieces and put them together anew."""

from __future__ import annotations

from tempose.signals import loops
from tempose.signals.edits._frames import check_length, frame_seconds, frame_span
from tempose.signals.signals import Signals
from tempose.signals.time.splice import Join, splice


def cut(signals: Signals, start: float, stop: float) -> Signals:
    """Take a part out.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: `start` is the first that goes, `stop` the first that stays.

    Returns
    -------
    Signals
        ``stop - start`` frames shorter, smooth at the seam.

    Raises
    ------
    ValueError
        If there are no such frames or nothing would be left.
    """
    a, b = frame_span(signals, start, stop)
    return _spliced(
        signals, [(0.0, a), (b, signals.duration)], "cut leaves nothing: from and to span the clip"
    )


def keep(signals: Signals, start: float, stop: float) -> Signals:
    """Keep a part and drop the rest.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: the first and the last that stay.

    Returns
    -------
    Signals
        Of that part.

    Raises
    ------
    ValueError
        If there are no such frames.
    """
    return _spliced(signals, [frame_span(signals, start, stop)])


def loop(signals: Signals, start: float, stop: float, times: int) -> Signals:
    """Play a part several times.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: `stop` shows, or nearly, what `start` does. It may be the frame after the last one,
        which nothing has captured: then all frames from `start` on are played again.
    times : int
        How often in all; 1 changes nothing.

    Returns
    -------
    Signals
        ``(times - 1) (stop - start)`` frames longer, smooth at the seams.

    Raises
    ------
    ValueError
        If there are no such frames, `times` is not 1 or more, or so many that nobody plays them.
    """
    last = signals.duration * signals.fps
    whole = not isinstance(stop, bool) and isinstance(stop, int | float) and abs(stop - last - 1) < 1e-6
    a, b = frame_span(signals, start, last if whole else stop)
    if isinstance(times, bool) or times != int(times) or times < 1:
        raise ValueError(f"times must be 1 or more, got {times!r}")
    check_length(last + (times - 1) * (b - a) * signals.fps, "times", times)
    if times == 1:
        return signals
    pieces = [(0.0, b), *[(a, b)] * (int(times) - 2), (a, signals.duration)]
    return _spliced(signals, pieces, joins=Join(apart=True) if whole else None)


def paste(signals: Signals, start: float, stop: float, at: float) -> Signals:
    """Copy a part to another moment.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: where the part begins and ends.
    at : float
        Frame from 0 at which the copy begins; what was there comes after it.

    Returns
    -------
    Signals
        ``stop - start`` frames longer, smooth at the seams.

    Raises
    ------
    ValueError
        If there are no such frames.
    """
    a, b = frame_span(signals, start, stop)
    c = frame_seconds(signals, at, "at")
    check_length((signals.duration + b - a) * signals.fps, "to", stop)
    return _spliced(signals, [(0.0, c), (a, b), (c, signals.duration)])


def reverse(signals: Signals, start: float, stop: float) -> Signals:
    """Play a part backwards.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: where the part begins and ends.

    Returns
    -------
    Signals
        As long as before, smooth at the seams.

    Raises
    ------
    ValueError
        If there are no such frames.
    """
    a, b = frame_span(signals, start, stop)
    return _spliced(signals, [(0.0, a), (b, a), (b, signals.duration)])


def close_loop(signals: Signals, start: float, stop: float, insert: int | None = None) -> Signals:
    """Keep a part that, played again and again, has no seam.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: where the loop begins and where it begins anew.
    insert : int, optional
        Frames to insert between end and begin; None lets the distance between the two decide.

    Returns
    -------
    Signals
        The loop, once.

    Raises
    ------
    ValueError
        If there are no such frames.
    """
    frame_span(signals, start, stop)
    if insert is not None:
        check_length(stop - start + insert, "insert", insert)
    return loops.close_loop(signals, start, stop, insert)


def _spliced(
    signals: Signals, pieces: list[tuple[float, float]], empty: str = "", joins: Join | None = None
) -> Signals:
    short = 1e-9 * signals.duration
    wanted = [(a, b) for a, b in pieces if abs(b - a) > short]
    if not wanted:
        raise ValueError(empty)
    return splice(signals, wanted, joins)
