"""Fewer frames, other frames, frames between frames."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeVar

import numpy as np

from tempose.clips.mesh_clip import MeshClip
from tempose.clips.skeleton import SkeletonClip
from tempose.rotations import slerp
from tempose.typing import FloatArray, IntArray

Clip = TypeVar("Clip", MeshClip, SkeletonClip)

_SNAP = 1e-9
"""Part of a frame below which a moment counts as the frame itself, so that rounding moves no frame."""


def select_frames(clip: Clip, start: int = 0, stop: int | None = None, step: int = 1) -> Clip:
    """Keep the frames ``start, start + step, ...`` before `stop`.

    Parameters
    ----------
    clip : MeshClip or SkeletonClip
        Clip of T frames.
    start : int, default 0
        First frame kept, 0-based.
    stop : int, optional
        First frame left out; None keeps all to the end.
    step : int, default 1
        Keep every step-th frame; the rate falls by the same factor, so that the motion keeps its speed.

    Returns
    -------
    MeshClip or SkeletonClip
        The shorter clip, over the same memory.

    Raises
    ------
    ValueError
        If no frame is left or an argument is out of range.
    """
    T = clip.n_frames
    if not 0 <= start < T:
        raise ValueError(f"start must be a frame from 0 to {T - 1}, got {start}")
    if stop is not None and not start < stop <= T:
        raise ValueError(f"stop must be after start ({start}) and at most {T}, got {stop}")
    if step < 1:
        raise ValueError(f"step must be at least 1, got {step}")
    kept = slice(start, stop, step)
    if isinstance(clip, SkeletonClip):
        return clip.frames(kept)
    return replace(clip, vertices=clip.vertices[kept], fps=clip.fps / step)


def resample(clip: Clip, fps: float) -> Clip:
    """Give a clip another frame rate at the same speed, from frame 0 on.

    Positions are interpolated linearly, rotations by slerp. A frame that falls on an old one is that frame.

    Parameters
    ----------
    clip : MeshClip or SkeletonClip
        Clip of T frames.
    fps : float
        New frames per second.

    Returns
    -------
    MeshClip or SkeletonClip
        ``floor(duration * fps) + 1`` frames: twice the rate gives ``2 (T - 1) + 1``.

    Raises
    ------
    ValueError
        If `fps` is not positive or the clip is empty.
    """
    if not 0 < fps < math.inf:
        raise ValueError(f"fps must be positive, got {fps}")
    if clip.n_frames == 0:
        raise ValueError("a clip without frames cannot be resampled")
    if fps == clip.fps:
        return clip
    before, weight = _neighbours(clip.n_frames, clip.fps, fps)
    if isinstance(clip, SkeletonClip):
        return replace(
            clip,
            rotations=_turned(clip.rotations, before, weight),
            root_position=_blended(clip.root_position, before, weight),
            fps=fps,
        )
    return replace(clip, vertices=_blended(clip.vertices, before, weight), fps=fps)


def _neighbours(T: int, old: float, new: float) -> tuple[IntArray, FloatArray]:
    """(T',) old frame at or before each new one, and how far the new one is past it, 0 to 1."""
    count = math.floor((T - 1) * new / old + _SNAP) + 1
    place = np.arange(count) * (old / new)
    before = np.minimum(np.floor(place + _SNAP * T).astype(np.int32), T - 1)
    weight = place - before
    return before, np.where(np.abs(weight) < _SNAP * T, 0.0, weight)


def _blended(values: FloatArray, before: IntArray, weight: FloatArray) -> FloatArray:
    result = np.zeros((len(before), *values.shape[1:]), values.dtype)
    for t, (i, w) in enumerate(zip(before, weight)):
        result[t] = values[i] if w == 0 else (1 - w) * values[i] + w * values[i + 1]
    return result


def _turned(rotations: FloatArray, before: IntArray, weight: FloatArray) -> FloatArray:
    after = np.minimum(before + 1, len(rotations) - 1)
    between = slerp(rotations[before], rotations[after], weight[:, None])
    return np.where(weight[:, None, None] == 0, rotations[before], between)
