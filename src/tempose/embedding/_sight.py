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
    seen = np.zeros(len(starts), dtype=np.bool_)
    for i in range(len(starts)):
        seen[i] = _line(inside, walls, walled, starts[i], ends[i])
    return seen


@njit(cache=True, nogil=True)
def _line(inside: BoolArray, walls: BoolArray, walled: bool, start: FloatArray, end: FloatArray) -> bool:
    way = end - start
    length = np.sqrt((way**2).sum())
    steps = int(np.ceil(2 * (length - _NEAR_SURFACE)))
    here = np.zeros(3, dtype=np.int64)
    for a in range(3):
        here[a] = int(np.round(start[a]))
        if here[a] < 0 or here[a] >= inside.shape[a]:
            return False
    for s in range(1, steps + 1):
        share = (length - _NEAR_SURFACE) / length * s / steps
        for a in range(3):
            there = int(np.round(start[a] + share * way[a]))
            if there == here[a]:
                continue
            if there < 0 or there >= inside.shape[a]:
                return False
            low = here.copy()
            low[a] = min(there, here[a])
            if walled and walls[a, low[0], low[1], low[2]]:
                return False
            here[a] = there
        if not inside[here[0], here[1], here[2]]:
            return False
    return True
