"""Between a body about its own origin and the body where it stands in the world."""

from __future__ import annotations

import numpy as np

from tempose.curves import Spline
from tempose.rotations import conjugate, normalise, to_matrix
from tempose.signals.placement.spline import placement_at
from tempose.typing import FloatArray


def place(V: FloatArray, placements: FloatArray) -> FloatArray:
    """Turn and move bodies to where they stand.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices about the body's own origin, metres.
    placements : (..., 7) float
        A rotation wxyz of any length, then a translation in metres.

    Returns
    -------
    (..., n, 3) ndarray
        ``R v + t``.
    """
    placements = np.asarray(placements, dtype=np.float64)
    R = to_matrix(normalise(placements[..., :4]))
    V = np.asarray(V, dtype=np.float64) @ np.swapaxes(R, -1, -2)
    V += placements[..., None, 4:]
    return V


def in_body(V: FloatArray, placements: FloatArray) -> FloatArray:
    """Take the placement out of bodies: the inverse of `place`.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices in the world, metres.
    placements : (..., 7) float
        A rotation wxyz of any length, then a translation in metres.

    Returns
    -------
    (..., n, 3) ndarray
        Vertices about the body's own origin.
    """
    placements = np.asarray(placements, dtype=np.float64)
    R = to_matrix(normalise(conjugate(placements[..., :4])))
    return (np.asarray(V, dtype=np.float64) - placements[..., None, 4:]) @ np.swapaxes(R, -1, -2)


def placed(V: FloatArray, placement: Spline | None, ticks: FloatArray | float) -> FloatArray:
    """Place what the shape signal gave, if the clip's placement was split off.

    Parameters
    ----------
    V : (..., n, 3) float
        Decoded vertices, one mesh for each tick.
    placement : Spline or None
        (7) over ticks; None: `V` stands where it should already.
    ticks : (...) float
        Where in the clip.

    Returns
    -------
    (..., n, 3) ndarray
        Vertices in the world, metres.
    """
    return V if placement is None else place(V, placement_at(placement, ticks))
