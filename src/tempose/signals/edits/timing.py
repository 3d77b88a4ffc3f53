"""Edits of the clock: retiming, slow and fast motion, frame rate. The curve stays as it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tempose._validate import as_floats
from tempose.curves import MonotoneMap, monotone_map
from tempose.signals.edits._frames import check_length, frame_span
from tempose.signals.signals import Signals
from tempose.typing import FloatArray


def retime(
    signals: Signals,
    times: Sequence[float] | FloatArray | None = None,
    keys: Sequence[Sequence[float]] | FloatArray | None = None,
) -> Signals:
    """Change which moment is played when (section 4.2 of the paper).

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    times : (T,) float, optional
        For each frame to be played, from 0, the second of what was played; never falling.
    keys : (K, 2) float, optional
        Instead: pairs of a frame to be played and the frame of what was played, the first pair beginning
        with 0; between them a monotone curve.

    Returns
    -------
    Signals
        With one retiming more.

    Raises
    ------
    ValueError
        If both or none of `times` and `keys` are given, or they run backwards or leave the clip.
    """
    if (times is None) == (keys is None):
        raise ValueError("retime needs either times or keys")
    if times is not None:
        values = as_floats(times, "times", ("T",)) * signals.rate
        places = np.arange(len(values)) / signals.fps * signals.rate
        name, unit = "times", signals.rate
    else:
        pairs = as_floats(keys, "keys", ("K", 2)) / signals.fps * signals.rate
        places, values = pairs[:, 0], pairs[:, 1]
        name, unit = "keys", signals.rate / signals.fps
    last = float(places.max(initial=0.0)) / signals.rate * signals.fps
    check_length(last, f"the last frame of {name}", last)
    _check_retiming(places, values, signals, name, unit)
    values = np.clip(values, 0.0, signals.duration * signals.rate)
    return _played_through(signals, monotone_map(places, values))


def _check_retiming(places: FloatArray, values: FloatArray, signals: Signals, name: str, unit: float) -> None:
    last = signals.duration * signals.rate
    if len(places) < 2:
        raise ValueError(f"{name} must hold 2 or more entries, got {len(places)}")
    if places[0] != 0 or (np.diff(places) <= 0).any():
        raise ValueError(f"{name} must begin with frame 0 and go on with ever later frames")
    if (np.diff(values) < 0).any():
        i = int(np.argmax(np.diff(values) < 0)) + 1
        raise ValueError(
            f"{name} must not run backwards, entry {i} does; for that there is the edit `reverse`"
        )
    outside = (values < -1e-9 * last) | (values > last * (1 + 1e-9) + 1e-12)
    if outside.any():
        i = int(np.argmax(outside))
        raise ValueError(f"{name} must stay from 0 to {last / unit:.6g}, entry {i} is {values[i] / unit:.6g}")


def set_speed(signals: Signals, start: float, stop: float, factor: float, ease: float = 2.0) -> Signals:
    """Play a part faster or slower; before and after it nothing changes but the moment.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    start, stop : float
        Frames from 0: where the part begins and ends.
    factor : float
        How much faster; below 1 slower.
    ease : float, default 2
        Frames at each end of the part, at most a quarter of it, in which the speed runs over.

    Returns
    -------
    Signals
        Whose speed has no jump.

    Raises
    ------
    ValueError
        If there are no such frames, the factor is not positive or `ease` is negative.
    """
    a, b = (s * signals.rate for s in frame_span(signals, start, stop))
    if not 0 < factor < math.inf:
        raise ValueError(f"factor must be positive, got {factor:.6g}")
    if not 0 <= ease < math.inf:
        raise ValueError(f"ease must be 0 or more frames, got {ease:.6g}")
    end = signals.duration * signals.rate
    # with no time to run over, a thousandth of the part: a map needs its keys apart
    ramp = min(max(ease * signals.rate / signals.fps, 1e-3 * (b - a)), 0.25 * (b - a))
    before, after = a > 1e-9 * end, b < end * (1 - 1e-9)
    values = [a, *([a + ramp] if before else []), *([b - ramp] if after else []), b]
    speeds = [1.0 if before else factor, *[factor] * (len(values) - 2), 1.0 if after else factor]
    lengths = [2 * (v1 - v0) / (s0 + s1) for v0, v1, s0, s1 in zip(values, values[1:], speeds, speeds[1:])]
    check_length(math.fsum(lengths) * signals.fps / signals.rate, "factor", factor)
    places = list(a + np.concatenate([[0.0], np.cumsum(lengths)]))
    if before:
        places, values, speeds = [0.0, *places], [0.0, *values], [1.0, *speeds]
    else:
        values[0], places[0] = 0.0, 0.0
    if after:
        places, values, speeds = [*places, places[-1] + end - b], [*values, end], [*speeds, 1.0]
    return _played_through(signals, MonotoneMap(np.array(places), np.array(values), np.array(speeds)))


def set_fps(signals: Signals, value: float) -> Signals:
    """Change how many frames a second are played.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    value : float
        Frames a second.

    Returns
    -------
    Signals
        Of the same seconds.

    Raises
    ------
    ValueError
        If the rate is not positive.
    """
    if not 0 < value < math.inf:
        raise ValueError(f"value must be a positive number of frames a second, got {value!r}")
    check_length(signals.duration * value, "value", value)
    return replace(signals, fps=float(value))


def _played_through(signals: Signals, retiming: MonotoneMap) -> Signals:
    return replace(signals, retimings=(retiming, *signals.retimings))
