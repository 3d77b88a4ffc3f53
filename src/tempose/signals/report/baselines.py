"""What simple interpolation would have done: of key frames, and of frames that were left out."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np
from scipy.interpolate import interp1d

from tempose.clips import MeshClip
from tempose.clips.resample import select_frames
from tempose.curves import interpolating_spline
from tempose.metrics import compare
from tempose.signals.fit.frames import clip_diagonal
from tempose.signals.model import SignalModel
from tempose.typing import FloatArray, IntArray, Progress, silent

LARGEST = 30_000_000
"""Coordinates of a clip above which nothing is measured: it would take longer than the fit."""

Errors = dict[str, float | None]


def key_frame_errors(clip: MeshClip, k: int) -> dict[str, Errors]:
    """Measure a clip that is keyed at as many frames as a curve has control points.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    k : int
        Key frames, spread evenly from the first frame to the last; T at most.

    Returns
    -------
    dict of str to dict
        Errors over all frames of ``linear`` and (natural) ``cubic`` interpolation of every vertex.
    """
    keys = np.unique(np.linspace(0, clip.n_frames - 1, max(min(k, clip.n_frames), 2)).round().astype(int))
    return _interpolated(clip, keys, np.arange(clip.n_frames))


def left_out_errors(
    clip: MeshClip, model: SignalModel, every: int = 2, progress: Progress = silent
) -> dict[str, Errors]:
    """Fit every n-th frame and measure how well those between are predicted.

    Parameters
    ----------
    clip : MeshClip
        T frames, at least ``2 every + 1`` of them.
    model : SignalModel
        Its options are used; k, l and m as far as the fewer frames allow. Where neither they nor a
        tolerance were given, nothing is lost at the frames that are kept.
    every : int, default 2
        Frames 0, n, 2 n... are kept.
    progress : Progress, default silent
        Told which stage is at work.

    Returns
    -------
    dict of str to dict
        Errors over the frames left out: ``ours``, ``linear`` and (natural) ``cubic`` interpolation of every
        vertex. Empty where too few frames are kept.
    """
    kept = np.arange(0, clip.n_frames, every)
    between = np.setdiff1d(np.arange(kept[-1]), kept)
    if len(kept) < 3 or len(between) == 0:
        return {}
    part = select_frames(clip, 0, None, every)
    fitted = SignalModel(**_options(model, len(kept), every)).fit(part, progress=progress)
    ours = fitted.sample(between / clip.fps, dtype=np.float64)
    return {"ours": _errors(clip, between, ours), **_interpolated(clip, kept, between)}


def _options(model: SignalModel, T: int, every: int) -> dict[str, Any]:
    given = asdict(model.options)
    if given["period"] not in (None, "auto"):
        period = given["period"] / every
        given["period"] = period if 1 < period < T - 1 else None
    if all(given[name] is None for name in ("tolerance", "k", "l", "m")):
        return given | {"k": T + 2, "l": T, "m": T - 1}
    for name, most in (("k", T + 2), ("l", T), ("m", T - 1)):
        if given[name] is not None:
            given[name] = min(given[name], most)
    return given


def _interpolated(clip: MeshClip, keys: IntArray, wanted: IntArray) -> dict[str, Errors]:
    V = np.asarray(clip.vertices[keys], dtype=np.float64).reshape(len(keys), -1)
    u, t = keys.astype(np.float64), wanted.astype(np.float64)
    return {
        "linear": _errors(clip, wanted, interp1d(u, V, axis=0)(t)),
        "cubic": _errors(clip, wanted, interpolating_spline(u, V)(t)),
    }


def _errors(clip: MeshClip, frames: IntArray, predicted: FloatArray) -> Errors:
    true = np.asarray(clip.vertices[frames], dtype=np.float64)
    found = compare(true, predicted.reshape(true.shape), clip_diagonal(clip)).as_dict()
    return {name: value if math.isfinite(value) else None for name, value in found.items()}
