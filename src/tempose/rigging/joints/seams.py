"""Vertices that are one place in every frame, as seams of textures leave them."""

from __future__ import annotations

import numpy as np

from tempose.geometry import weld
from tempose.typing import FloatArray, IntArray

_SAME = 1e-5  # of the diagonal


def distinct_vertices(rest: FloatArray, frames: FloatArray) -> tuple[IntArray, IntArray]:
    """Take one vertex for each place that stays one place.

    Parameters
    ----------
    rest : (n, 3) float
        Rest positions.
    frames : (T, n, 3) float
        Positions in every frame.

    Returns
    -------
    first : (u,) ndarray of int
        Vertices to keep.
    back : (n,) ndarray of int
        Which of them stands for each vertex.

    Notes
    -----
    Vertices that are together at rest and part in some frame, by 1e-5 of the diagonal, all stay.
    """
    first, back = weld(np.ascontiguousarray(rest))
    stands = first[back]
    reach = _SAME * float(np.linalg.norm(np.ptp(rest, axis=0)))
    parts = np.zeros(len(rest), dtype=bool)
    for frame in frames:
        parts |= np.abs(frame - frame[stands]).max(axis=1) > reach
    stands = np.where(parts, np.arange(len(rest)), stands)
    return np.unique(stands, return_inverse=True)
