"""Surface nets: a mesh of an implicit surface, one vertex a grid cell that the surface crosses."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.samples.field import FAR, Field, parts_near, value
from tempose.typing import FloatArray, IntArray

BLOCK = 8
"""Grid points along the side of a cube that is looked at or skipped as a whole."""


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
    """Field at grid points; far from the surface only its sign is right."""
    n = blocks * BLOCK
    grid = np.full((n[0], n[1], n[2]), np.float32(FAR))
    N = len(field.parent)
    core, drop, near = np.zeros(N + 8), np.zeros(N), np.zeros(len(field.kind), dtype=np.int64)
    for block in range(blocks[0] * blocks[1] * blocks[2]):
        i = block // (blocks[1] * blocks[2]) * BLOCK
        j = block // blocks[2] % blocks[1] * BLOCK
        k = block % blocks[2] * BLOCK
        half = 0.5 * (BLOCK - 1) * step
        corner = lower + step * np.array([float(i), float(j), float(k)])
        count = parts_near(field, corner[0] + half, corner[1] + half, corner[2] + half, half, near)
        if not _fill(field, near[:count], lower, step, grid, (i, j, k), BLOCK, core, drop):
            continue
        for c in range(8):
            quarter = (i + 4 * (c & 1), j + 4 * (c >> 1 & 1), k + 4 * (c >> 2))
            if not _fill(field, near[:count], lower, step, grid, quarter, 4, core, drop):
                continue
            for d in range(8):
                pair = (quarter[0] + 2 * (d & 1), quarter[1] + 2 * (d >> 1 & 1), quarter[2] + 2 * (d >> 2))
                if _fill(field, near[:count], lower, step, grid, pair, 2, core, drop):
                    for e in range(8):
                        point = (pair[0] + (e & 1), pair[1] + (e >> 1 & 1), pair[2] + (e >> 2))
                        _fill(field, near[:count], lower, step, grid, point, 1, core, drop)
    return grid


@njit(cache=True, error_model="numpy")
def _fill(
    field: Field,
    near: IntArray,
    lower: FloatArray,
    step: float,
    grid: FloatArray,
    first: tuple[int, int, int],
    size: int,
    core: FloatArray,
    drop: FloatArray,
) -> bool:
    """Fill a cube of grid points with the field at its centre; tell whether the surface may be in it."""
    i, j, k = first
    half = 0.5 * (size - 1)
    x, y, z = lower[0] + (i + half) * step, lower[1] + (j + half) * step, lower[2] + (k + half) * step
    f = value(field, near, x, y, z, core, drop)
    for a in range(i, i + size):
        for b in range(j, j + size):
            for c in range(k, k + size):
                grid[a, b, c] = f
    # the field is a distance to first order only, and the cell beyond must be right, too
    return abs(f) < 1.5 * 0.5 * np.sqrt(3.0) * (size + 0.5) * step


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
