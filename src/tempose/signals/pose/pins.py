"""Frames that the user keeps at places of the pose plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray, IntArray

Pins = Mapping[int, Sequence[float] | FloatArray]
"""Frame to its place (2,) in the pose plane."""


def check_pins(pins: Pins, distances: FloatArray) -> tuple[IntArray, FloatArray, tuple[str, ...]]:
    """Check pinned frames against the poses they show.

    Parameters
    ----------
    pins : mapping of int to (2,) float
        Frame to its place.
    distances : (n, n) float
        Distances between the poses of all frames.

    Returns
    -------
    frames : (c,) ndarray of int
        Pinned frames, ascending.
    places : (c, 2) ndarray
        Where they are kept.
    warnings : tuple of str
        What will not come out as asked, with its measure.

    Raises
    ------
    ValueError
        If a frame does not exist, a place is not finite, frames whose poses differ by more than a mean
        step share one place, or all frames are pinned on one line though their poses are not.
    """
    n = len(distances)
    for frame in pins:
        if not isinstance(frame, (int, np.integer)) or not 0 <= frame < n:
            raise ValueError(f"pins must name frames 0 to {n - 1}, got {frame!r}")
    frames = np.array(sorted(pins), dtype=np.int64)
    rows = [as_floats(pins[int(f)], f"pins[{f}]", (2,)) for f in frames]
    places = np.array(rows, dtype=np.float64).reshape(-1, 2)
    warnings = _shared_places(frames, places, distances)
    if len(frames) == n and n > 2:
        _refuse_line(places, distances)
    return frames, places, warnings


def _shared_places(frames: IntArray, places: FloatArray, distances: FloatArray) -> tuple[str, ...]:
    if len(frames) < 2:
        return ()
    extent = max(float(np.abs(places - places.mean(axis=0)).max()), 1e-300)
    gaps = np.linalg.norm(places[:, None] - places[None], axis=2)
    a, b = np.nonzero(np.triu(gaps <= 1e-9 * extent, 1))
    if len(a) == 0:
        return ()
    apart = distances[frames[a], frames[b]]
    differ = apart > 1e-9 * distances.max()
    if not differ.any():
        return ()
    worst = int(np.argmax(apart))
    i, j = int(frames[a[worst]]), int(frames[b[worst]])
    step = float(np.diagonal(distances, 1).mean())
    what = (
        f"frames {i} and {j} are pinned at one place, {places[a[worst]].tolist()}, but their poses differ by "
        f"{apart[worst]:.3g}, {apart[worst] / max(step, 1e-300):.2g} times the mean step between frames"
    )
    if apart[worst] > step:
        raise ValueError(f"pins: {what}; a place has one pose: pin them apart")
    return (f"{what}: the pose there will be their mean",)


def _refuse_line(places: FloatArray, distances: FloatArray) -> None:
    centred = places - places.mean(axis=0)
    length, width = np.linalg.svd(centred, compute_uv=False)
    squared = np.square(distances)
    gram = squared.mean(axis=0) + squared.mean(axis=1)[:, None] - squared - squared.mean()
    spread = np.sort(np.linalg.eigvalsh(0.5 * gram))[::-1]
    if width <= 1e-9 * length and spread[1] > 1e-12 * spread[0]:
        raise ValueError(
            f"pins hold all {len(places)} frames on one line (width {width / max(length, 1e-300):.2g} of its "
            f"length), but the poses are not on one (second spread {np.sqrt(spread[1] / spread[0]):.2g} of "
            "the first); move one off the line, or leave frames free"
        )
