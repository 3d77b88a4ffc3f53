"""Frames in blocks, so that a memory-mapped clip of any length can be measured."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tempose.clips.blocks import cut_blocks

BLOCK_VALUES = 500_000
"""Numbers held in one block: 4 MB as float64, so that most of it stays in the cache."""


def check_clip(V: Any, name: str) -> Any:
    """Check that an array is a clip; its values are checked block by block as they are read.

    Parameters
    ----------
    V : (T, n, 3) array
        Array or memory map.
    name : str
        Name of the argument, for the message.

    Returns
    -------
    (T, n, 3) array
        The same memory.

    Raises
    ------
    ValueError
        If the shape is another, the type is no number, or there is not one frame and one vertex.
    """
    V = V if isinstance(V, np.ndarray) else np.asarray(V)
    if V.ndim != 3 or V.shape[2] != 3 or V.dtype.kind not in "fiu":
        raise ValueError(f"{name} must be numbers of shape (T, n, 3), got {V.dtype} of shape {V.shape}")
    if V.shape[0] == 0 or V.shape[1] == 0:
        raise ValueError(f"{name} must hold at least one frame and one vertex, got shape {V.shape}")
    return V


def block_slices(n_frames: int, values_per_frame: int) -> Iterator[slice]:
    """Cut a clip into blocks of frames.

    Parameters
    ----------
    n_frames : int
        Number of frames T.
    values_per_frame : int
        Numbers that the caller makes of one frame.

    Returns
    -------
    iterator of slice
        Frames of one block after another.
    """
    return cut_blocks(n_frames, values_per_frame, BLOCK_VALUES)
