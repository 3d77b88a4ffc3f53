"""Lines of sight through the cells of a solid."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import BoolArray, FloatArray

_NEAR_SURFACE = 1.6


@njit(cache=True, nogil=True)
def sees(
    inside: BoolArray, walls: BoolArray, walled: bool, starts: FloatArray, ends: FloatArray
) -> BoolArray:
    """Tell which points on the surface are seen from points inside.

    Parameters
    ----------
    inside : (X, Y, Z) bool
        Cells of the solid.
    walls : (3, X, Y, Z) bool
        Where the surface runs between a cell and the next along each axis.
    walled : bool
        Whether walls block the sight.
    starts, ends : (k, 3) float
        Points inside and points on the surface, in units of cells.

    Returns
    -------
    (k,) ndarray of bool
        Whether every cell on the way is inside; the last one and a half before the surface do not count.
    """
    seen = np.ones(len(starts), dtype=np.bool_)
    shape = np.array(inside.shape)
    for i in range(len(starts)):
        way = ends[i] - starts[i]
        length = np.sqrt((way**2).sum())
        steps = int(np.ceil(2 * (length - _NEAR_SURFACE)))
        here = np.zeros(3, dtype=np.int64)
        for a in range(3):
            here[a] = int(np.round(starts[i, a]))
        for s in range(1, steps + 1):
            share = (length - _NEAR_SURFACE) / length * s / steps
            for a in range(3):
                there = int(np.round(starts[i, a] + share * way[a]))
                if there == here[a]:
                    continue
                low = min(there, here[a])
                if walled and 0 <= low < shape[a]:
                    at = here.copy()
                    at[a] = low
                    if walls[a, at[0], at[1], at[2]]:
                        seen[i] = False
                here[a] = there
                if there < 0 or there >= shape[a]:
                    seen[i] = False
                    break
            if not seen[i] or not inside[here[0], here[1], here[2]]:
                seen[i] = False
                break
    return seen
