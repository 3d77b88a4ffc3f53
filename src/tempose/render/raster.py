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


def rasterise(P: FloatArray, F: IntArray, width: int, height: int) -> tuple[IntArray, FloatArray]:
    """Find the nearest triangle at every pixel centre.

    Parameters
    ----------
    P : (n, 3) float
        x to the right and y downwards in pixels, and nearness: larger is nearer, and linear on the screen
        (one over depth for perspective, minus depth for parallel projection). NaN hides a vertex's faces.
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
    fill(np.ascontiguousarray(P, dtype=np.float64), F, face, nearness)
    return face, nearness


@njit(cache=True, nogil=True)
def fill(P: FloatArray, F: IntArray, face: IntArray, nearness: FloatArray) -> None:  # pragma: no cover
    """Draw triangles into a z-buffer.

    Parameters
    ----------
    P : (n, 3) float64
        As in `rasterise`.
    F : (m, 3) int32
        Triangles.
    face : (height, width) int32
        Written where a triangle is nearer than what is there; of shape (0, 0) to draw depth only.
    nearness : (height, width) float32
        Read and written.
    """
    height, width = nearness.shape
    limit = 1e6  # beyond it the integers of the edge functions could overflow
    for f in range(F.shape[0]):
        a, b, c = F[f, 0], F[f, 1], F[f, 2]
        xa, ya, xb, yb, xc, yc = P[a, 0], P[a, 1], P[b, 0], P[b, 1], P[c, 0], P[c, 1]
        low_x, high_x = min(xa, xb, xc), max(xa, xb, xc)
        low_y, high_y = min(ya, yb, yc), max(ya, yb, yc)
        # Written so that NaN fails it too.
        inside = high_x > 0.0 and low_x < width and high_y > 0.0 and low_y < height
        if not (inside and low_x > -limit and high_x < limit and low_y > -limit and high_y < limit):
            continue
        box = (
            max(int(np.floor(low_x - 0.5)), 0),
            min(int(np.ceil(high_x + 0.5)), width),
            max(int(np.floor(low_y - 0.5)), 0),
            min(int(np.ceil(high_y + 0.5)), height),
        )
        if _area(xa, ya, xb, yb, xc, yc) < 0:
            xb, yb, xc, yc, b, c = xc, yc, xb, yb, c, b
        corners = (_snap(xa), _snap(ya), _snap(xb), _snap(yb), _snap(xc), _snap(yc))
        _fill_triangle(corners, (P[a, 2], P[b, 2], P[c, 2]), box, f, face, nearness)


@njit(cache=True, nogil=True, inline="always")
def _snap(x):  # type: ignore[no-untyped-def]
    return np.int64(np.floor(x * 256.0 + 0.5))


@njit(cache=True, nogil=True, inline="always")
def _area(xa, ya, xb, yb, xc, yc):  # type: ignore[no-untyped-def]
    ax, ay = _snap(xa), _snap(ya)
    return (_snap(xb) - ax) * (_snap(yc) - ay) - (_snap(yb) - ay) * (_snap(xc) - ax)


@njit(cache=True, nogil=True)
def _fill_triangle(corners, near, box, f, face, nearness):  # type: ignore[no-untyped-def]
    xa, ya, xb, yb, xc, yc = corners
    area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)
    if area == 0:
        return
    # An edge owns its own points when it goes down, or right: its twin in the neighbour goes the other way.
    own_a = 0 if yc - yb > 0 or (yc == yb and xc > xb) else 1
    own_b = 0 if ya - yc > 0 or (ya == yc and xa > xc) else 1
    own_c = 0 if yb - ya > 0 or (yb == ya and xb > xa) else 1
    x0 = np.int64(box[0]) * 256 + 128
    write_face = face.shape[0] > 0
    for j in range(box[2], box[3]):
        y = np.int64(j) * 256 + 128
        ea = (xc - xb) * (y - yb) - (yc - yb) * (x0 - xb)
        eb = (xa - xc) * (y - yc) - (ya - yc) * (x0 - xc)
        ec = (xb - xa) * (y - ya) - (yb - ya) * (x0 - xa)
        for i in range(box[0], box[1]):
            if ea >= own_a and eb >= own_b and ec >= own_c:
                w = np.float32((ea * near[0] + eb * near[1] + ec * near[2]) / area)
                if w > nearness[j, i]:
                    nearness[j, i] = w
                    if write_face:
                        face[j, i] = f
            ea -= (yc - yb) * 256
            eb -= (ya - yc) * 256
            ec -= (yb - ya) * 256
