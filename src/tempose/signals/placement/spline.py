"""The placement as a function of time."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.curves import Spline, interpolating_spline
from tempose.rotations import normalise
from tempose.typing import FloatArray


def placement_spline(placements: FloatArray, ticks: FloatArray | None = None) -> Spline:
    """Return the spline through the placements of frames.

    Parameters
    ----------
    placements : (T, 7) float
        Rotations wxyz and translations in metres.
    ticks : (T,) float, optional
        Where the frames are; frame numbers by default.

    Returns
    -------
    Spline
        (7) over ticks. Its rotations are not of unit length between frames: see `placement_at`.
    """
    placements = as_floats(placements, "placements", ("T", 7))
    ticks = np.arange(float(len(placements))) if ticks is None else ticks
    return interpolating_spline(ticks, continuous_signs(placements))


def placement_at(placement: Spline, ticks: FloatArray | float) -> FloatArray:
    """Evaluate a placement.

    Parameters
    ----------
    placement : Spline
        (7) over ticks.
    ticks : (...) float
        Where in the clip.

    Returns
    -------
    (..., 7) ndarray
        Unit quaternions wxyz and translations, metres.
    """
    values = placement(ticks)
    return np.concatenate([normalise(values[..., :4]), values[..., 4:]], axis=-1)


def continuous_signs(placements: FloatArray) -> FloatArray:
    """Give each rotation the one of its two quaternions that is nearer to the frame before.

    Parameters
    ----------
    placements : (T, 7) float
        Rotations wxyz and translations.

    Returns
    -------
    (T, 7) ndarray
        The same placements.
    """
    result = np.array(placements, dtype=np.float64)
    q = result[:, :4]
    turns = np.where(np.sum(q[1:] * q[:-1], axis=1) < 0, -1.0, 1.0)
    q[1:] *= np.cumprod(turns)[:, None]
    return result
