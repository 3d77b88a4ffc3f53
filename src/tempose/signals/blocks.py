"""Frames of a clip in blocks, so that a memory map of any length can be fitted and written."""

from __future__ import annotations

from collections.abc import Iterator

from tempose.clips.blocks import cut_blocks

BLOCK_VALUES = 2_000_000
"""Numbers in one block: 16 MB as float64. Products with a matrix as wide as a frame need blocks this tall."""


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
