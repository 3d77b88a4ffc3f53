"""Light that arrives at a point: look-ups in the depth maps of `lights`, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.render.lights import Lights
from tempose.typing import FloatArray


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
    result = np.zeros((len(points), 3))
    for i, (p, n) in enumerate(zip(points, normals)):
        result[i] = gather_at(p[0], p[1], p[2], n[0], n[1], n[2], *light_arrays(lights))
    return result


def light_arrays(lights: Lights) -> tuple[FloatArray, ...]:
    """Return what `gather_at` takes, in its order.

    Parameters
    ----------
    lights : Lights
        Lights.

    Returns
    -------
    tuple
        Arrays and the offset along the normal that keeps a surface out of its own shadow, metres.
    """
    return (  # type: ignore[return-value]
        lights.directions,
        lights.weights,
        lights.kind,
        lights.frames,
        lights.maps,
        1.6 * lights.texel,
    )


@njit(cache=True, nogil=True)
def gather_at(px, py, pz, nx, ny, nz, directions, weights, kind, frames, maps, offset):  # type: ignore[no-untyped-def]
    """Sum the light at one point, as `gather`.

    Parameters
    ----------
    px, py, pz : float
        Point.
    nx, ny, nz : float
        Unit normal.
    directions, weights, kind, frames, maps, offset : ndarray
        As `light_arrays` gives them.

    Returns
    -------
    (float, float, float)
        Key, sky and ground.
    """
    x, y, z = px + offset * nx, py + offset * ny, pz + offset * nz
    key, sky, bounce = 0.0, 0.0, 0.0
    for k in range(directions.shape[0]):
        d = directions[k]
        cosine = d[0] * nx + d[1] * ny + d[2] * nz
        if cosine <= 0.0:
            continue
        open_share = weights[k] * _lit(k, x, y, z, d, frames, maps)
        if kind[k] == 0:
            key += open_share
        elif kind[k] == 1:
            sky += open_share * cosine
        else:
            bounce += open_share * cosine
    return key, sky, bounce


@njit(cache=True, nogil=True, inline="always")
def _lit(k, x, y, z, d, frames, maps):  # type: ignore[no-untyped-def]
    # Compared first, averaged after: four neighbours, weighted bilinearly.
    u = frames[k, 0, 0] * x + frames[k, 0, 1] * y + frames[k, 0, 2] * z + frames[k, 0, 3] - 0.5
    v = frames[k, 1, 0] * x + frames[k, 1, 1] * y + frames[k, 1, 2] * z + frames[k, 1, 3] - 0.5
    size = maps.shape[1]
    if not (u >= 0.0 and v >= 0.0 and u < size - 1.0 and v < size - 1.0):
        return 1.0
    i, j = int(u), int(v)
    a, b = u - i, v - j
    height = np.float32(d[0] * x + d[1] * y + d[2] * z)
    lit = 0.0
    if maps[k, j, i] <= height:
        lit += (1 - a) * (1 - b)
    if maps[k, j, i + 1] <= height:
        lit += a * (1 - b)
    if maps[k, j + 1, i] <= height:
        lit += (1 - a) * b
    if maps[k, j + 1, i + 1] <= height:
        lit += a * b
    return lit
