"""Where axis-parallel lines through a grid cross a mesh."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import BoolArray, FloatArray, IntArray


@njit(cache=True, nogil=True)
def _side(ay: float, az: float, by: float, bz: float, y: float, z: float) -> float:
    # both triangles at an edge must get the same number, up to its sign, or lines slip between them
    if ay < by or (ay == by and az <= bz):
        return (by - ay) * (z - az) - (bz - az) * (y - ay)
    return -((ay - by) * (z - bz) - (az - bz) * (y - by))


@njit(cache=True, nogil=True)
def line_crossings(V: FloatArray, F: IntArray, out: IntArray, walls: BoolArray) -> None:
    """Count signed crossings of the lines along the first axis with a mesh.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, in units of cells: the centre of cell (i, j, k) lies at those numbers.
    F : (m, 3) int
        Faces, counter-clockwise seen from outside.
    out : (X, Y, Z) int32
        Added to: between cells i and i + 1, +1 for every face entered and -1 for every face left.
    walls : (X, Y, Z) bool
        Set where there is any face between cells i and i + 1.

    Notes
    -----
    Of a closed mesh this is exactly the difference of the winding number between the two cells.
    """
    X, Y, Z = out.shape
    for f in range(len(F)):
        a, b, c = V[F[f, 0]], V[F[f, 1]], V[F[f, 2]]
        j0 = max(int(np.ceil(min(a[1], b[1], c[1]))), 0)
        j1 = min(int(np.floor(max(a[1], b[1], c[1]))), Y - 1)
        k0 = max(int(np.ceil(min(a[2], b[2], c[2]))), 0)
        k1 = min(int(np.floor(max(a[2], b[2], c[2]))), Z - 1)
        for j in range(j0, j1 + 1):
            for k in range(k0, k1 + 1):
                u = _side(b[1], b[2], c[1], c[2], j, k)
                v = _side(c[1], c[2], a[1], a[2], j, k)
                w = _side(a[1], a[2], b[1], b[2], j, k)
                if not ((u > 0 and v > 0 and w > 0) or (u < 0 and v < 0 and w < 0)):
                    continue
                x = (u * a[0] + v * b[0] + w * c[0]) / (u + v + w)
                i = int(np.floor(x))
                if 0 <= i < X:
                    out[i, j, k] += -1 if u > 0 else 1
                    walls[i, j, k] = True
