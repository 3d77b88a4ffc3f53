"""Where the frames of a result are kept: in memory, or in a file when they are too many."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np

from tempose.typing import FloatArray, IntArray

BLOCK = 16
"""Frames handled together after they are solved."""


def make_frames(n_frames: int, n_vertices: int, scratch: str | os.PathLike[str] | None = None) -> FloatArray:
    """Make room for the frames of a clip.

    Parameters
    ----------
    n_frames, n_vertices : int
        T and n.
    scratch : path-like, optional
        Folder for the frames; without one they are held in memory.

    Returns
    -------
    (T, n, 3) ndarray of float32
        Zeros; with `scratch` a memory map of a new file there, which is the caller's to delete.

    Raises
    ------
    OSError
        If the folder cannot be written or has no room; the message names it.
    """
    shape = (n_frames, n_vertices, 3)
    if scratch is None:
        return np.zeros(shape, dtype=np.float32)
    folder = Path(scratch)
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: no such folder to keep frames in; create it first")
    needed, free = 4 * int(np.prod(shape, dtype=np.int64)), shutil.disk_usage(folder).free
    if needed > free:
        # a sparse file would be made and break later, with a signal instead of an error
        raise OSError(f"{folder}: no room for frames: {needed >> 20} MB are needed, {free >> 20} MB are free")
    number = sum(1 for _ in folder.glob("frames-*.bin"))
    path = folder / f"frames-{os.getpid()}-{number}.bin"
    return _FrameFile(path, dtype=np.float32, mode="w+", shape=shape)


class _FrameFile(np.memmap):
    """A memory map that lets go of what was read before when it is read from again."""

    def __getitem__(self, index: Any) -> Any:
        release(self)
        return super().__getitem__(index)


def gather(frames: FloatArray, vertices: IntArray) -> FloatArray:
    """Read some vertices of every frame.

    Parameters
    ----------
    frames : (T, n, 3) float
        From `make_frames`.
    vertices : (k,) int
        Which vertices.

    Returns
    -------
    (T, k, 3) ndarray of float64
        Their positions.
    """
    found = np.zeros((len(frames), len(vertices), 3))
    for start in range(0, len(frames), BLOCK):
        found[start : start + BLOCK] = frames[start : start + BLOCK][:, vertices]
    return found


def release(frames: Any) -> None:
    """Let go of the pages of a memory map that are in memory; what was written stays in its file.

    Parameters
    ----------
    frames : ndarray
        From `make_frames`, or a view of it; an array in memory is left alone.
    """
    while frames is not None and not isinstance(frames, np.memmap):
        frames = getattr(frames, "base", None)
    mapped: Any = getattr(frames, "_mmap", None)
    if mapped is not None and hasattr(mapped, "madvise"):
        import mmap

        mapped.madvise(mmap.MADV_DONTNEED)
