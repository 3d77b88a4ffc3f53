"""Surface nets: a mesh of an implicit surface, one vertex a grid cell that the surface crosses."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.samples.field import FAR, Field, parts_near, value
from tempose.typing import FloatArray, IntArray

BLOCK = 4
"""Grid steps along the side of a block that is looked at or skipped as a whole."""


def surface_nets(
    field: Field, lower: FloatArray, upper: FloatArray, step: float
) -> tuple[FloatArray, IntArray]:
    """Mesh the zero set of a field inside a box.

    Parameters
    ----------
    field : Field
        The implicit surface; it must not touch the sides of the box.
    lower, upper : (3,) float
        Corners of the box, metres.
    step : float
        Side of a grid cell, metres.

    Returns
    -------
    V : (n, 3) ndarray
        Vertices, metres.
    F : (m, 3) ndarray of int64
        Faces, counter-clockwise from outside.

    Notes
    -----
    The dual method of Gibson [1]_, with quads cut along the shorter diagonal. Closed always; a two-manifold
    as long as no grid cell is crossed by two sheets of the surface.

    References
    ----------
    .. [1] Gibson, "Constrained Elastic Surface Nets", MICCAI 1998.
    """
    shape = np.ceil((np.asarray(upper) - lower) / (step * BLOCK)).astype(np.int64)
    grid = _sample(field, np.asarray(lower, dtype=np.float64), step, shape)
    V, cell = _vertices(grid)
    F = _faces(grid, cell, V)
    return V * step + lower, F


@njit(cache=True, error_model="numpy")
def _sample(field: Field, lower: FloatArray, step: float, blocks: IntArray) -> FloatArray:
    n = blocks * BLOCK
    grid = np.full((n[0], n[1], n[2]), np.float32(FAR))
    N = len(field.parent)
    core, drop, near = np.zeros(N + 8), np.zeros(N), np.zeros(len(field.kind), dtype=np.int64)
    # the field is a distance only to first order: hence the factor beyond the half diagonal
    reach = 1.5 * 0.5 * np.sqrt(3.0) * BLOCK * step
    for bi in range(blocks[0]):
        for bj in range(blocks[1]):
            for bk in range(blocks[2]):
                i0, j0, k0 = bi * BLOCK, bj * BLOCK, bk * BLOCK
                half = 0.5 * (BLOCK - 1)
                x = lower[0] + (i0 + half) * step
                y = lower[1] + (j0 + half) * step
                z = lower[2] + (k0 + half) * step
                count = parts_near(field, x, y, z, half * step, near)
                middle = value(field, near[:count], x, y, z, core, drop)
                for i in range(i0, i0 + BLOCK):
                    for j in range(j0, j0 + BLOCK):
                        for k in range(k0, k0 + BLOCK):
                            f = middle
                            if abs(middle) < reach:
                                x = lower[0] + i * step
                                y = lower[1] + j * step
                                z = lower[2] + k * step
                                f = value(field, near[:count], x, y, z, core, drop)
                            grid[i, j, k] = f
    return grid


@njit(cache=True, error_model="numpy")
def _vertices(grid: FloatArray) -> tuple[FloatArray, IntArray]:
    a, b, c = grid.shape
    cell = np.full((a - 1, b - 1, c - 1), -1, dtype=np.int32)
    count = 0
    for i in range(a - 1):
        for j in range(b - 1):
            for k in range(c - 1):
                inside = 0
                for q in range(8):
                    inside += grid[i + (q & 1), j + (q >> 1 & 1), k + (q >> 2)] < 0.0
                if 0 < inside < 8:
                    cell[i, j, k] = count
                    count += 1
    V = np.zeros((count, 3))
    for i in range(a - 1):
        for j in range(b - 1):
            for k in range(c - 1):
                if cell[i, j, k] >= 0:
                    _crossing(grid, i, j, k, V[cell[i, j, k]])
    return V, cell


@njit(cache=True, error_model="numpy")
def _crossing(grid: FloatArray, i: int, j: int, k: int, out: FloatArray) -> None:
    total = 0
    for p in range(8):
        for axis in range(3):
            q = p | 1 << axis
            if q == p:
                continue
            f = grid[i + (p & 1), j + (p >> 1 & 1), k + (p >> 2)]
            g = grid[i + (q & 1), j + (q >> 1 & 1), k + (q >> 2)]
            if (f < 0.0) != (g < 0.0):
                t = f / (f - g)
                out[0] += (p & 1) + (t if axis == 0 else 0.0)
                out[1] += (p >> 1 & 1) + (t if axis == 1 else 0.0)
                out[2] += (p >> 2) + (t if axis == 2 else 0.0)
                total += 1
    out /= total
    out[0] += i
    out[1] += j
    out[2] += k


@njit(cache=True, error_model="numpy")
def _faces(grid: FloatArray, cell: IntArray, V: FloatArray) -> IntArray:
    a, b, c = cell.shape
    F = np.zeros((6 * len(V) + 64, 3), dtype=np.int64)
    m = 0
    quad = np.zeros(4, dtype=np.int64)
    for i in range(1, a):
        for j in range(1, b):
            for k in range(1, c):
                f = grid[i, j, k] < 0.0
                for axis in range(3):
                    g = grid[i + (axis == 0), j + (axis == 1), k + (axis == 2)] < 0.0
                    if f == g:
                        continue
                    # the four cells around this grid edge, counter-clockwise seen from its far end
                    if axis == 0:
                        quad[:] = cell[i, j - 1, k - 1], cell[i, j, k - 1], cell[i, j, k], cell[i, j - 1, k]
                    elif axis == 1:
                        quad[:] = cell[i - 1, j, k - 1], cell[i - 1, j, k], cell[i, j, k], cell[i, j, k - 1]
                    else:
                        quad[:] = cell[i - 1, j - 1, k], cell[i, j - 1, k], cell[i, j, k], cell[i - 1, j, k]
                    if g:
                        quad[1], quad[3] = quad[3], quad[1]
                    s = 0 if _distance2(V, quad[0], quad[2]) <= _distance2(V, quad[1], quad[3]) else 1
                    F[m] = quad[s], quad[s + 1], quad[(s + 2) % 4]
                    F[m + 1] = quad[s], quad[(s + 2) % 4], quad[(s + 3) % 4]
                    m += 2
    return F[:m].copy()


@njit(cache=True, error_model="numpy")
def _distance2(V: FloatArray, i: int, j: int) -> float:
    d0, d1, d2 = V[i, 0] - V[j, 0], V[i, 1] - V[j, 1], V[i, 2] - V[j, 2]
    return d0 * d0 + d1 * d1 + d2 * d2
