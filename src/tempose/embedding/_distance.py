"""Distance of cells inside to the nearest one outside (Felzenszwalb and Huttenlocher 2012)."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import BoolArray, FloatArray, IntArray


@njit(cache=True, nogil=True)
def distance_inside(inside: BoolArray) -> FloatArray:
    """Distance of every cell to the nearest one outside, in cells.

    Parameters
    ----------
    inside : (X, Y, Z) bool
        Cells of a solid, at least one of them outside.

    Returns
    -------
    (X, Y, Z) ndarray
        Between centres of cells; 0 outside.

    Notes
    -----
    Squared distances, one axis after the other: along each line the lower envelope of parabolas.
    """
    X, Y, Z = inside.shape
    far = float(X * X + Y * Y + Z * Z)
    squared = np.zeros(inside.shape)
    for x in range(X):
        for y in range(Y):
            _along(inside[x, y], squared[x, y], far)
    size = max(X, Y) + 1
    line, out, cuts = np.zeros(size), np.zeros(size), np.zeros(size + 1)
    site = np.zeros(size, dtype=np.int64)
    for x in range(X):
        for z in range(Z):
            if _filled(squared[x, :, z], line):
                _envelope(line, Y, site, cuts, out)
                squared[x, :, z] = out[:Y]
    for y in range(Y):
        for z in range(Z):
            if _filled(squared[:, y, z], line):
                _envelope(line, X, site, cuts, out)
                squared[:, y, z] = out[:X]
    return np.sqrt(squared)


@njit(cache=True, nogil=True)
def _along(inside: BoolArray, squared: FloatArray, far: float) -> None:
    last = -1
    for k in range(len(inside)):
        if not inside[k]:
            last = k
        squared[k] = far if last < 0 else float((k - last) ** 2)
    last = -1
    for k in range(len(inside) - 1, -1, -1):
        if not inside[k]:
            last = k
        if last >= 0:
            squared[k] = min(squared[k], float((k - last) ** 2))


@njit(cache=True, nogil=True)
def _filled(values: FloatArray, line: FloatArray) -> bool:
    """Copy a line; tell whether there is anything on it."""
    found = False
    for k in range(len(values)):
        line[k] = values[k]
        found = found or values[k] > 0
    return found


@njit(cache=True, nogil=True)
def _envelope(f: FloatArray, n: int, site: IntArray, cuts: FloatArray, out: FloatArray) -> None:
    k = 0
    site[0] = 0
    cuts[0], cuts[1] = -np.inf, np.inf
    for q in range(1, n):
        while True:
            p = site[k]
            s = ((f[q] + q * q) - (f[p] + p * p)) / (2.0 * (q - p))
            if s > cuts[k]:
                break
            k -= 1
        k += 1
        site[k] = q
        cuts[k], cuts[k + 1] = s, np.inf
    k = 0
    for q in range(n):
        while cuts[k + 1] < q:
            k += 1
        out[q] = (q - site[k]) ** 2 + f[site[k]]
