"""Frames out of signals: one, many, or more than fit into memory."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.signals.blocks import block_slices
from tempose.signals.placement import placed
from tempose.signals.room import check_room
from tempose.signals.signals import Signals
from tempose.typing import FloatArray


def sample_blocks(
    signals: Signals, times: FloatArray, dtype: Any = np.float32
) -> Iterator[tuple[slice, FloatArray]]:
    """Evaluate signals a block of times after another.

    Parameters
    ----------
    signals : Signals
        What to play.
    times : (K,) float
        Seconds.
    dtype : dtype, default float32
        Of the vertices.

    Yields
    ------
    where : slice
        Which of the times.
    vertices : (k, n, 3) ndarray
        Positions there, metres.

    Raises
    ------
    ValueError
        If a time is not finite.
    """
    times = as_floats(times, "times", ("K",))
    for where in block_slices(len(times), signals.shape.space.dimension):
        yield where, evaluate(signals, times[where], dtype)


def evaluate(
    signals: Signals, times: FloatArray, dtype: Any = np.float32, out: FloatArray | None = None
) -> FloatArray:
    """Evaluate signals at a few times at once.

    Parameters
    ----------
    signals : Signals
        What to play.
    times : (...) float
        Seconds.
    dtype : dtype, default float32
        Of the vertices.
    out : (..., n, 3) array, optional
        Where to write; then its type counts.

    Returns
    -------
    (..., n, 3) ndarray
        Positions, metres.
    """
    V = signals.shape.vertices(signals.coordinates(times), dtype, out)
    return placed(V, signals.placement, signals.ticks(times), V)


def sample(signals: Signals, times: FloatArray, out: Any = None, dtype: Any = np.float32) -> FloatArray:
    """Evaluate signals at any number of times.

    Parameters
    ----------
    signals : Signals
        What to play.
    times : (...) float
        Seconds.
    out : (..., n, 3) array, optional
        Where to write; a memory map holds what memory does not.
    dtype : dtype, default float32
        Of the result, where `out` is not given.

    Returns
    -------
    (..., n, 3) ndarray
        `out`, or a new array.

    Raises
    ------
    ValueError
        If a time is not finite, `out` has another shape, or a new array would not fit into memory.
    """
    times = np.asarray(times, dtype=np.float64)
    shape = (*times.shape, signals.shape.space.n_vertices, 3)
    if out is None and times.ndim == 0:
        if not math.isfinite(times):
            raise ValueError(f"times must be finite, got {times}")
        return evaluate(signals, times, dtype)
    if out is None:
        check_room(
            math.prod(shape) * np.dtype(dtype).itemsize / 1e9,
            f"{math.prod(times.shape)} frames of {shape[-2]} vertices",
            "take them in blocks (sample_blocks), or give a memory map as out",
        )
    flat = as_floats(times.reshape(-1), "times", ("K",))
    if out is None:
        rows = np.zeros((len(flat), *shape[-2:]), dtype)
    elif out.shape != shape or len(shape) != 3:
        raise ValueError(f"out must have shape (K, {shape[-2]}, 3) for K times, got {out.shape}")
    else:
        rows = out
    for where in block_slices(len(flat), signals.shape.space.dimension):
        evaluate(signals, flat[where], out=rows[where])
    return rows.reshape(shape) if out is None else out
