"""Shadows on the floor, computed where they change."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

import numpy as np
from numba import njit

from tempose.render.gather import gather_at, light_arrays
from tempose.render.lights import Lights
from tempose.typing import BoolArray, FloatArray

KEY_SHARE = 0.6
"""Share of the key light in the light on the floor; the rest comes from the sky."""


def floor_shadow(
    spot: FloatArray, level: float, lights: Lights, wanted: BoolArray, size: tuple[int, int], stride: int
) -> FloatArray:
    """Return how much light is missing on the floor.

    Parameters
    ----------
    spot : (height * width, 2) float
        x and z, metres.
    level : float
        Height, metres.
    lights : Lights
        What throws shadows.
    wanted : (height * width,) bool
        Where it must be known.
    size : (int, int)
        Width and height, pixels.
    stride : int
        As in `floor_picture`.

    Returns
    -------
    (height * width,) ndarray of float64
        0 in the open, 1 in the deepest shadow.
    """
    shade = np.full(len(spot), -1.0)
    arrays = light_arrays(lights)[:-1]
    _shadows(spot, float(level), wanted, size[0], size[1], stride, KEY_SHARE, shade, *arrays)
    return np.maximum(shade, 0.0)


@njit(cache=True, nogil=True)
def _shadows(spot, level, wanted, width, height, stride, key_share, shade, dirs, weights, kind, frames, maps):
    up, light, point = np.array([0.0, 1.0, 0.0]), np.zeros(3), np.zeros(3)
    last_i, last_j = (width - 1) // stride * stride, (height - 1) // stride * stride
    for step in (stride, 1):
        for j in range(0, height, step):
            for i in range(0, width, step):
                k = j * width + i
                if not wanted[k] or shade[k] >= 0.0:
                    continue
                if step < stride:
                    i0, j0 = i - i % stride, j - j % stride
                    i1, j1 = min(i0 + stride, last_i), min(j0 + stride, last_j)
                    a, b = shade[j0 * width + i0], shade[j0 * width + i1]
                    c, d = shade[j1 * width + i0], shade[j1 * width + i1]
                    if min(a, b, c, d) >= 0.0 and max(a, b, c, d) - min(a, b, c, d) < 0.02:
                        s, t = (i - i0) / stride, (j - j0) / stride
                        shade[k] = (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d)
                        continue
                point[0], point[1], point[2] = spot[k, 0], level, spot[k, 1]
                gather_at(point, up, dirs, weights, kind, frames, maps, 0.0, light)
                shade[k] = 1.0 - key_share * light[0] - (1.0 - key_share) * light[1]
