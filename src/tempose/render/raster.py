"""Which triangle is seen where: a z-buffer.

Corners are snapped to 1/256 of a pixel and the edge functions are integers, so that triangles that share an
edge neither overlap nor leave a crack. Pixel (i, j) is sampled at (i + 0.5, j + 0.5).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray

SUBPIXELS = 256
"""Positions per pixel along each axis."""

_OUTSIDE = 1 << 30  # Farther out, in subpixels, the integers of the edge functions could overflow.


def rasterise(P: FloatArray, F: IntArray, width: int, height: int) -> tuple[IntArray, FloatArray]:
    """Find the nearest triangle at every pixel centre.

    Parameters
    ----------
    P : (n, 3) float
        x to the right and y downwards in pixels, and nearness: larger is nearer, and linear on the screen
        (one over depth for perspective, minus depth for parallel projection). NaN hides a vertex's faces,
        and so does a place more than four million pixels away.
    F : (m, 3) int
        Triangles.
    width, height : int
        Pixels.

    Returns
    -------
    face : (height, width) ndarray of int32
        Nearest triangle; -1 where there is none. Of equally near ones the first.
    nearness : (height, width) ndarray of float32
        Its nearness; minus infinity where there is none.
    """
    face = np.full((height, width), -1, dtype=np.int32)
    nearness = np.full((height, width), -np.inf, dtype=np.float32)
    Q = np.ascontiguousarray(np.asarray(P, dtype=np.float64).T)
    fill(snapped(Q[0]), snapped(Q[1]), Q[2], np.ascontiguousarray(F, dtype=np.int32), face, nearness)
    return face, nearness


def snapped(x: FloatArray) -> IntArray:
    """Round pixels to subpixels.

    Parameters
    ----------
    x : (n,) float
        Pixels.

    Returns
    -------
    (n,) ndarray of int64
        Subpixels; what is no number or too far away gets the largest magnitude, which `fill` leaves out.
    """
    y = np.floor(x * SUBPIXELS + 0.5)
    return np.where(np.abs(y) < _OUTSIDE, y, _OUTSIDE).astype(np.int64)


@njit(cache=True, nogil=True)
def fill(
    X: IntArray, Y: IntArray, near: FloatArray, F: IntArray, face: IntArray, nearness: FloatArray
) -> None:
    """Draw triangles into a z-buffer.

    Parameters
    ----------
    X, Y : (n,) int64
        Places of the vertices, in subpixels.
    near : (n,) float64
        Their nearness, as in `rasterise`.
    F : (m, 3) int32
        Triangles.
    face : (height, width) int32
        Written where a triangle is nearer than what is there; of shape (0, 0) to draw depth only.
    nearness : (height, width) float32
        Read and written.
    """
    height, width = nearness.shape
    for f in range(F.shape[0]):
        a, b, c = F[f, 0], F[f, 1], F[f, 2]
        xa, ya, xb, yb, xc, yc = X[a], Y[a], X[b], Y[b], X[c], Y[c]
        # Bounds in pixels whose centres can lie inside; many triangles of a fine mesh have none.
        i0, i1 = max((min(xa, xb, xc) + 127) >> 8, 0), min((max(xa, xb, xc) + 128) >> 8, width)
        if i0 >= i1:
            continue
        j0, j1 = max((min(ya, yb, yc) + 127) >> 8, 0), min((max(ya, yb, yc) + 128) >> 8, height)
        area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)
        if j0 >= j1 or area == 0 or max(xa, xb, xc, ya, yb, yc) >= _OUTSIDE:
            continue
        za, zb, zc = near[a], near[b], near[c]
        if area < 0:
            xb, yb, zb, xc, yc, zc, area = xc, yc, zc, xb, yb, zb, -area
        # Edge functions and their steps. An edge owns its own points when it goes down, or right: its twin
        # in the neighbour goes the other way.
        ax, ay, bx, by, cx, cy = xc - xb, yc - yb, xa - xc, ya - yc, xb - xa, yb - ya
        own_a = 0 if ay > 0 or (ay == 0 and ax > 0) else 1
        own_b = 0 if by > 0 or (by == 0 and bx > 0) else 1
        own_c = 0 if cy > 0 or (cy == 0 and cx > 0) else 1
        wa, wb, wc = za / area, zb / area, zc / area
        x = (i0 << 8) + 128
        for j in range(j0, j1):
            y = (j << 8) + 128
            ea = ax * (y - yb) - ay * (x - xb) - own_a
            eb = bx * (y - yc) - by * (x - xc) - own_b
            ec = cx * (y - ya) - cy * (x - xa) - own_c
            for i in range(i0, i1):
                if (ea | eb | ec) >= 0:
                    w = np.float32((ea + own_a) * wa + (eb + own_b) * wb + (ec + own_c) * wc)
                    if w > nearness[j, i]:
                        nearness[j, i] = w
                        if face.shape[0] > 0:
                            face[j, i] = f
                ea -= ay << 8
                eb -= by << 8
                ec -= cy << 8
