"""Keys through time: a cubic through those of one part, a smooth window round them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.typing import FloatArray, IntArray


@dataclass
class Key:
    """Frames in which adjustments of one part are in full force."""

    first: int
    """Key frame."""
    last: int
    """Last frame of the hold."""
    before: float
    """Frames in which it comes."""
    after: float
    """Frames in which it goes."""
    pinned: bool = False
    """Whether its offset is known also while it comes and goes, so that nothing is extrapolated."""
    members: list[int] = field(default_factory=list[int])
    """Which adjustments, in their order."""


def make_layers(keys: Sequence[Key]) -> list[list[list[Key]]]:
    """Sort keys of one part into layers, and each layer into runs.

    Parameters
    ----------
    keys : sequence of Key
        One an adjustment, in their order.

    Returns
    -------
    list of list of list of Key
        Layers add up. In a layer no two keys share a frame; those whose windows overlap are one run, which is
        interpolated. Adjustments of the same frames are one key.
    """
    layers: list[list[Key]] = []
    for key in keys:
        for layer in layers:
            same = next((k for k in layer if (k.first, k.last) == (key.first, key.last)), None)
            if same is not None:
                same.members += key.members
                same.before, same.after = max(same.before, key.before), max(same.after, key.after)
                same.pinned = same.pinned or key.pinned
                break
            if all(key.last < k.first or key.first > k.last for k in layer):
                layer.append(key)
                break
        else:
            layers.append([key])
    return [_runs(sorted(layer, key=lambda k: k.first)) for layer in layers]


def _runs(layer: list[Key]) -> list[list[Key]]:
    runs = [[layer[0]]]
    for key in layer[1:]:
        end = max(k.last + k.after for k in runs[-1])
        if key.first - key.before < end:
            runs[-1].append(key)
        else:
            runs.append([key])
    return runs


def run_curve(
    run: Sequence[Key], offsets: Callable[[Key, IntArray], FloatArray], n_frames: int
) -> FloatArray:
    """Curve of one run: through its keys, and smoothly to zero on both sides.

    Parameters
    ----------
    run : sequence of Key
        Keys in time.
    offsets : callable
        Key and frames (k,) to the (k, 3) values there.
    n_frames : int
        Number of frames T.

    Returns
    -------
    (T, 3) ndarray
        The values in the frames of each key; between keys the natural cubic spline, whose second derivative
        is least; outside the window exactly 0.
    """
    frames, values = [], []
    for j, key in enumerate(run):
        a, b = key.first, key.last
        if key.pinned and j == 0:
            a = max(0, int(np.floor(key.first - key.before)))
        if key.pinned and j == len(run) - 1:
            b = min(n_frames - 1, int(np.ceil(key.last + key.after)))
        mine = np.arange(a, b + 1)
        frames.append(mine)
        values.append(offsets(key, mine))
    weight = window(n_frames, run[0].first, run[-1].last, run[0].before, run[-1].after)
    at = np.flatnonzero(weight)
    out = np.zeros((n_frames, 3))
    out[at] = weight[at, None] * natural_cubic(np.concatenate(frames), np.concatenate(values), at)
    return out


def window(n_frames: int, first: int, last: int, before: float, after: float) -> FloatArray:
    """Weight of an adjustment in every frame.

    Parameters
    ----------
    n_frames : int
        Number of frames T.
    first, last : int
        Frames of full weight.
    before, after : float
        Frames in which it comes and goes.

    Returns
    -------
    (T,) ndarray
        1 from `first` to `last`; ``6 s^5 - 15 s^4 + 10 s^3`` beside them, which joins with two continuous
        derivatives; exactly 0 outside.
    """
    t = np.arange(n_frames, dtype=np.float64)
    ahead = np.maximum(first - t, t - last)
    length = np.where(t < first, before, after)
    s = np.clip(1 - ahead / np.where(length > 0, length, 1e-9), 0.0, 1.0)
    return s * s * s * (s * (6 * s - 15) + 10)


def natural_cubic(keys: IntArray, values: FloatArray, at: IntArray) -> FloatArray:
    """Interpolate by the cubic spline of least acceleration, continued by straight lines.

    Parameters
    ----------
    keys : (k,) int
        Increasing times.
    values : (k, c) float
        Values there.
    at : (n,) int
        Times asked for.

    Returns
    -------
    (n, c) ndarray
        Values; two continuous derivatives everywhere.
    """
    if len(keys) == 1:
        return np.repeat(values, len(at), axis=0)
    spline = CubicSpline(keys, values, bc_type="natural")
    inside = np.clip(at, keys[0], keys[-1])
    return spline(inside) + (at - inside)[:, None] * spline(inside, 1)
