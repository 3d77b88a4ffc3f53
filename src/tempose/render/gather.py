"""Light that arrives at a point: look-ups in the depth maps of `tempose.render.lights`."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.render.lights import Lights
from tempose.typing import FloatArray, IntArray


def gather(points: FloatArray, normals: FloatArray, lights: Lights) -> FloatArray:
    """Sum the light that arrives at surface points.

    Parameters
    ----------
    points : (k, 3) float
        Metres.
    normals : (k, 3) float
        Unit normals of the side that is seen.
    lights : Lights
        Where light comes from and what is in the way.

    Returns
    -------
    (k, 3) ndarray of float64
        Share of the key light that is not in shadow (before the cosine), light of the sky, light from below;
        an open plane that faces up receives 1, 1 and 0.
    """
    light = np.zeros((len(points), 3))
    apart = np.arange(len(points))  # A pixel for each: none shares its light.
    _gather_shared(apart, np.zeros(len(points)), _rows(points), _rows(normals), light, *light_arrays(lights))
    return light


def _rows(X: FloatArray) -> FloatArray:
    return np.ascontiguousarray(X, dtype=np.float64)


def light_arrays(lights: Lights) -> tuple[Any, ...]:
    """Return what `gather_at` takes after point and normal.

    Parameters
    ----------
    lights : Lights
        Lights.

    Returns
    -------
    tuple
        Arrays, and the offset along the normal that keeps a surface out of its own shadow, metres.
    """
    return (
        lights.directions,
        lights.weights,
        lights.kind,
        lights.frames,
        lights.maps,
        1.6 * lights.texel,
    )


@njit(cache=True, nogil=True)
def gather_at(p, n, directions, weights, kind, frames, maps, offset, light):
    """Sum the light at one point, as `gather`.

    Parameters
    ----------
    p, n : (3,) float64
        Point and unit normal.
    directions, weights, kind, frames, maps, offset : ndarray and float
        As `light_arrays` gives them.
    light : (3,) float64
        Written: key, sky, ground.
    """
    x, y, z = p[0] + offset * n[0], p[1] + offset * n[1], p[2] + offset * n[2]
    key, sky, bounce = 0.0, 0.0, 0.0
    for k in range(directions.shape[0]):
        dx, dy, dz = directions[k, 0], directions[k, 1], directions[k, 2]
        cosine = dx * n[0] + dy * n[1] + dz * n[2]
        if cosine <= 0.0:
            continue
        share = weights[k] * _lit(maps, frames, k, dx * x + dy * y + dz * z, x, y, z)
        if kind[k] == 0:
            key += share
        elif kind[k] == 1:
            sky += share * cosine
        else:
            bounce += share * cosine
    light[0], light[1], light[2] = key, sky, bounce


@njit(cache=True, nogil=True)
def _lit(maps, frames, k, height, x, y, z):
    # Compared first, averaged after: four neighbours, weighted bilinearly.
    u = frames[k, 0, 0] * x + frames[k, 0, 1] * y + frames[k, 0, 2] * z + frames[k, 0, 3] - 0.5
    v = frames[k, 1, 0] * x + frames[k, 1, 1] * y + frames[k, 1, 2] * z + frames[k, 1, 3] - 0.5
    size = maps.shape[1]
    if not (u >= 0.0 and v >= 0.0 and u < size - 1.0 and v < size - 1.0):
        return 1.0
    i, j = int(u), int(v)
    a, b = u - i, v - j
    low = 1.0 if maps[k, j, i] <= height else 0.0
    low += a * ((1.0 if maps[k, j, i + 1] <= height else 0.0) - low)
    high = 1.0 if maps[k, j + 1, i] <= height else 0.0
    high += a * ((1.0 if maps[k, j + 1, i + 1] <= height else 0.0) - high)
    return low + b * (high - low)


def gather_shared(
    pixel: IntArray, depth: FloatArray, points: FloatArray, normals: FloatArray, lights: Lights
) -> FloatArray:
    """Sum the light at samples of a picture; those of one pixel on one surface share it.

    Parameters
    ----------
    pixel : (k,) int64
        Pixel of each sample; those of one pixel follow each other.
    depth : (k,) float64
        Metres before the eye.
    points, normals : (k, 3) float64
        As in `gather`.
    lights : Lights
        Light and what is in its way.

    Returns
    -------
    (k, 3) ndarray of float64
        As `gather`.
    """
    light = np.zeros((len(pixel), 3))
    _gather_shared(pixel, depth, points, normals, light, *light_arrays(lights))
    return light


@njit(cache=True, nogil=True)
def _gather_shared(pixel, depth, points, normals, light, dirs, weights, kind, frames, maps, offset):
    first = 0
    for k in range(len(points)):
        if k == 0 or pixel[k] != pixel[k - 1]:
            first = k
        n, found = normals[k], False
        for j in range(first, k):
            m = normals[j]
            same = n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.97
            if same and abs(depth[j] - depth[k]) < 0.004 * abs(depth[k]):
                light[k, 0], light[k, 1], light[k, 2] = light[j, 0], light[j, 1], light[j, 2]
                found = True
                break
        if not found:
            gather_at(points[k], n, dirs, weights, kind, frames, maps, offset, light[k])
