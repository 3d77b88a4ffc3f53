"""Which frames a foot is held in: what the detector found, cleaned, or what the user says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tempose.metrics import detect_contacts
from tempose.typing import BoolArray, FloatArray

_LOOSE = 1.5
_GAP = 0.1
"""Seconds: a foot that is off the ground for less, and still low and slow, is not let go."""
_SHORT = 0.05
"""Seconds: a foot that touches for less is not held."""
_LOW, _SLOW = 0.03, 0.25

Intervals = Mapping[str, Sequence[Sequence[int]]]
"""Foot name to its stance intervals, each [first frame, first frame after it]."""


def steady_contacts(points: Sequence[FloatArray], height: float, fps: float) -> BoolArray:
    """Find when feet stand, without chatter.

    Parameters
    ----------
    points : sequence of (T, f, 3) float
        Points of the source's f feet, such as balls and ankles, metres: a foot stands while any of its
        points does, so that it is held from heel strike to toe-off.
    height : float
        Height of the source, metres.
    fps : float
        Frames per second.

    Returns
    -------
    (T, f) ndarray of bool
        Contacts of `tempose.metrics.detect_contacts` with short gaps closed where the foot stays low and
        slow by half as much again, and short touches left out.
    """
    tight = np.any([detect_contacts(p, height, fps) for p in points], axis=0)
    loose = np.any([detect_contacts(p, height, fps, _LOOSE * _LOW, _LOOSE * _SLOW) for p in points], axis=0)
    out = np.zeros_like(tight)
    for f in range(tight.shape[1]):
        mine = tight[:, f].copy()
        for first, stop in intervals(~mine):
            inside = first > 0 and stop < len(mine)
            if inside and stop - first <= _GAP * fps and loose[first:stop, f].all():
                mine[first:stop] = True
        for first, stop in intervals(mine):
            inside = first > 0 and stop < len(mine)
            out[first:stop, f] = not inside or stop - first >= _SHORT * fps
    return out


def intervals(mask: BoolArray) -> list[tuple[int, int]]:
    """List the runs of frames in which something holds.

    Parameters
    ----------
    mask : (T,) bool
        One value a frame.

    Returns
    -------
    list of (int, int)
        First frame of each run and the first after it.
    """
    edges = np.flatnonzero(np.diff(np.r_[0, np.asarray(mask, dtype=np.int8), 0]))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2])]


def given_contacts(
    contacts: Intervals | BoolArray, names: Sequence[str], n_frames: int, first_frame: int = 0
) -> BoolArray:
    """Read the contacts that a user states.

    Parameters
    ----------
    contacts : mapping or (n_frames, f) bool
        Foot name to intervals [first frame, first frame after it], 0-based; or one column a foot.
    names : sequence of str
        The f feet.
    n_frames : int
        Frames of the source.
    first_frame : int, default 0
        First frame of the source that is motion; those before are left out of the answer.

    Returns
    -------
    (n_frames - first_frame, f) ndarray of bool
        Contacts; feet that are not named never stand.

    Raises
    ------
    ValueError
        If a foot is unknown, an interval is no interval of the clip, or the shape is another; the message
        says what was expected.
    """
    if not isinstance(contacts, Mapping):
        mask = np.asarray(contacts)
        if mask.dtype != np.bool_ or mask.shape != (n_frames, len(names)):
            raise ValueError(
                f"contacts must be bool of shape ({n_frames}, {len(names)}), one column each for "
                f"{', '.join(names) or 'no foot'}; got {mask.dtype} of shape {mask.shape}"
            )
        return mask[first_frame:]
    mask = np.zeros((n_frames, len(names)), dtype=bool)
    for name, listed in contacts.items():
        if name not in names:
            raise ValueError(f"contacts name the foot {name!r}; known are {', '.join(names) or 'none'}")
        for interval in listed:
            first, stop = _checked(interval, name, n_frames)
            mask[first:stop, list(names).index(name)] = True
    return mask[first_frame:]


def _checked(interval: Any, name: str, n_frames: int) -> tuple[int, int]:
    whole = isinstance(interval, Sequence) and len(interval) == 2 and all(type(x) is int for x in interval)
    if not whole or not 0 <= interval[0] < interval[1] <= n_frames:
        raise ValueError(
            f"contacts of {name} must be intervals [first, stop] with 0 <= first < stop <= {n_frames}, "
            f"got {interval!r}"
        )
    return interval[0], interval[1]
