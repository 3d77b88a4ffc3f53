"""How far a character sinks into the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tempose.clips.blocks import read_block
from tempose.metrics._frames import block_slices, check_clip
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Penetration:
    """Depth of the deepest vertex below the ground."""

    max_cm: float
    """Of the worst frame, centimetres."""
    mean_cm: float
    """Mean over the frames, zero where nothing is below, centimetres."""
    max_percent: float
    """Of the worst frame, percent of the height."""
    mean_percent: float
    """Mean over the frames, percent of the height."""


def ground_depths(V: FloatArray, ground: float = 0.0) -> FloatArray:
    """Depth of the deepest vertex of each frame.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip, metres; an array or a memory map.
    ground : float, default 0
        Height of the ground along Y, metres.

    Returns
    -------
    (T,) ndarray
        Metres below the ground, 0 where nothing is.

    Raises
    ------
    ValueError
        If the clip is empty or holds NaN.
    """
    V = check_clip(V, "V")
    depths = np.zeros(len(V))
    for frames in block_slices(len(V), V.shape[1] * 3):
        depths[frames] = ground - read_block(V, frames, "V")[..., 1].min(axis=1)
    return np.maximum(depths, 0.0)


def penetration(V: FloatArray, height: float, ground: float = 0.0) -> Penetration:
    """Measure how far a clip sinks into the ground.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip, metres; an array or a memory map.
    height : float
        Height of the character, metres.
    ground : float, default 0
        Height of the ground along Y, metres.

    Returns
    -------
    Penetration
        All zero where nothing is below the ground.

    Raises
    ------
    ValueError
        If the clip is empty or holds NaN, or `height` is not positive.
    """
    if not 0 < height < math.inf:
        raise ValueError(f"height must be positive, got {height}")
    depths, height = ground_depths(V, ground), float(height)
    deepest, mean = float(depths.max()), float(depths.mean())
    return Penetration(100 * deepest, 100 * mean, 100 * deepest / height, 100 * mean / height)
