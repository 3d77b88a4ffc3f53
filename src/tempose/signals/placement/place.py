"""Between a body about its own origin and the body where it stands in the world."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.curves import Spline
from tempose.signals.placement._rigid import place_each, unplace_each
from tempose.typing import FloatArray


def place(V: FloatArray, placements: FloatArray, out: FloatArray | None = None) -> FloatArray:
    """Turn and move bodies to where they stand.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices about the body's own origin, metres.
    placements : (..., 7) float
        A rotation wxyz of any length, then a translation in metres; one for all, or one for each body.
    out : (..., n, 3) array, optional
        Where to write; may be `V`.

    Returns
    -------
    (..., n, 3) ndarray
        ``R v + t``, of single precision if `V` is; `out` if it is given.
    """
    return _each(place_each, V, placements, out)


def in_body(V: FloatArray, placements: FloatArray, out: FloatArray | None = None) -> FloatArray:
    """Take the placement out of bodies: the inverse of `place`.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices in the world, metres.
    placements : (..., 7) float
        A rotation wxyz of any length, then a translation in metres; one for all, or one for each body.
    out : (..., n, 3) array, optional
        Where to write; may be `V`.

    Returns
    -------
    (..., n, 3) ndarray
        Vertices about the body's own origin.
    """
    return _each(unplace_each, V, placements, out)


def placed(
    V: FloatArray, placement: Spline | None, ticks: FloatArray | float, out: FloatArray | None = None
) -> FloatArray:
    """Place what the shape signal gave, if the clip's placement was split off.

    Parameters
    ----------
    V : (..., n, 3) float
        Decoded vertices, one mesh for each tick.
    placement : Spline or None
        (7) over ticks; None: `V` stands where it should already.
    ticks : (...) float
        Where in the clip.
    out : (..., n, 3) array, optional
        Where to write if there is a placement; may be `V`.

    Returns
    -------
    (..., n, 3) ndarray
        Vertices in the world, metres.
    """
    return V if placement is None else place(V, placement(ticks), out)


def _each(kernel: Any, V: FloatArray, placements: FloatArray, out: FloatArray | None) -> FloatArray:
    V = np.asarray(V)
    V = V if V.dtype == np.float32 else V.astype(np.float64, copy=False)
    placements = np.asarray(placements, dtype=np.float64)
    batch = np.broadcast_shapes(V.shape[:-2], placements.shape[:-1])
    shape = (*batch, *V.shape[-2:])
    result = np.zeros(shape, V.dtype) if out is None else out
    if result.shape != shape:
        raise ValueError(f"out must have shape {shape}, got {result.shape}")
    flat = result.reshape(-1, *shape[-2:])
    V = np.ascontiguousarray(np.broadcast_to(V, shape)).reshape(-1, *shape[-2:])
    rows = np.ascontiguousarray(np.broadcast_to(placements, (*batch, 7))).reshape(-1, 7)
    kernel(V, rows, flat)
    if not np.shares_memory(flat, result):
        result[...] = flat.reshape(shape)
    return result
