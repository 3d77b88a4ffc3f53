"""Frames of a clip in blocks, so that a memory map of any length can be read."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tempose.typing import FloatArray


def cut_blocks(n_frames: int, values_per_frame: int, values_per_block: int) -> Iterator[slice]:
    """Cut a clip into blocks of frames.

    Parameters
    ----------
    n_frames : int
        Number of frames T.
    values_per_frame : int
        Numbers that the caller makes of one frame.
    values_per_block : int
        Numbers that a block may hold; it has one frame at least.

    Yields
    ------
    slice
        Frames of one block, in order; never empty.
    """
    step = max(1, values_per_block // max(values_per_frame, 1))
    for start in range(0, n_frames, step):
        yield slice(start, min(start + step, n_frames))


def read_block(V: FloatArray, frames: slice, name: str = "vertices") -> FloatArray:
    """Read frames as float64.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    frames : slice
        Which frames, with both ends given.
    name : str, default "vertices"
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
        t, v = (int(i) for i in np.argwhere(~np.isfinite(part))[0][:2])
        raise ValueError(
            f"{name} must be finite, found NaN or infinity in frame {frames.start + t}, vertex {v}"
        )
    return part
