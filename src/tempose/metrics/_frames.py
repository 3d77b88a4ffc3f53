"""Frames in blocks, so that a memory-mapped clip of any length can be measured."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tempose.typing import FloatArray

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

    Yields
    ------
    slice
        Frames of one block, in order; never empty.
    """
    step = max(1, BLOCK_VALUES // max(values_per_frame, 1))
    for start in range(0, n_frames, step):
        yield slice(start, min(start + step, n_frames))


def block(V: Any, frames: slice, name: str) -> FloatArray:
    """Read a block of frames as float64.

    Parameters
    ----------
    V : (T, n, 3) array
        Clip, as `check_clip` returns it.
    frames : slice
        Which frames, with both ends given.
    name : str
        Name of the argument, for the message.

    Returns
    -------
    (k, n, 3) ndarray
        The frames.

    Raises
    ------
    ValueError
        If a value is NaN or infinite; the message names the frame and the vertex.
    """
    part = np.asarray(V[frames], dtype=np.float64)
    if not np.isfinite(part).all():
        t, v, _ = (int(i) for i in np.argwhere(~np.isfinite(part))[0])
        raise ValueError(
            f"{name} must be finite, found NaN or infinity in frame {frames.start + t}, vertex {v}"
        )
    return part
