"""What is seen of a mesh: position, normal and colour at every covered sample, and the light there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from tempose.render.camera import Camera
from tempose.render.gather import gather_at, light_arrays
from tempose.render.lights import Lights
from tempose.render.raster import rasterise
from tempose.typing import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of the picture that a triangle covers, s * s per pixel, in the order of their pixels."""

    size: tuple[int, int]
    """Width and height of the picture, pixels."""
    per_pixel: int
    """Samples per pixel, s * s."""
    pixel: IntArray
    """(k,) pixel of each sample, row times width plus column."""
    face: IntArray
    """(k,) triangle of each sample."""
    weights: FloatArray
    """(k, 3) float64 barycentric coordinates in the world."""
    screen_weights: FloatArray
    """(k, 3) float64 barycentric coordinates on the screen."""
    position: FloatArray
    """(k, 3) float64, metres."""
    depth: FloatArray
    """(k,) float64 metres before the eye."""
    projected: FloatArray
    """(n, 3) vertices in the picture of s times the size: x, y and nearness."""


def trace(V: FloatArray, F: IntArray, camera: Camera, size: tuple[int, int], s: int) -> Samples:
    """Find what every sample of a picture sees.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Triangles; those that reach behind the eye are left out.
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.
    s : int
        Samples per pixel along each axis.

    Returns
    -------
    Samples
        The covered samples.
    """
    width, height = size
    P = camera.project(V, (width * s, height * s))
    parallel = camera.fov == 0
    near = 1e-4 * max(float(np.abs(P[:, 2]).max(initial=0.0)), 1e-9)
    with np.errstate(divide="ignore"):
        nearness = -P[:, 2] if parallel else np.where(P[:, 2] > near, 1.0 / P[:, 2], np.nan)
    P[~np.isfinite(nearness)] = np.nan
    P[:, 2] = nearness
    face, _ = rasterise(P, F, width * s, height * s)
    by_pixel = face.reshape(height, s, width, s).transpose(0, 2, 1, 3).reshape(-1)
    covered = np.flatnonzero(by_pixel >= 0)
    pixel, sub = covered // (s * s), covered % (s * s)
    x = (pixel % width) * s + sub % s + 0.5
    y = (pixel // width) * s + sub // s + 0.5
    hit = by_pixel[covered]
    on_screen = _barycentric(P[F[hit], :2], x, y)
    scaled = on_screen if parallel else on_screen * P[F[hit], 2]
    weights = scaled / scaled.sum(axis=1, keepdims=True)
    position = np.einsum("kc,kcd->kd", weights, V[F[hit]])
    depth = (camera.position - position) @ camera.axes[2]
    return Samples(size, s * s, pixel, hit, weights, on_screen, position, depth, P)


def _barycentric(corners: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    # Corners are snapped to 1/256 pixel when drawn: clip what this leaves outside the triangle.
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    area = np.where(area == 0, 1.0, area)
    wb = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / area
    wc = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / area
    W = np.clip(np.stack([1 - wb - wc, wb, wc], axis=1), 0.0, 1.0)
    return W / W.sum(axis=1, keepdims=True)


def oriented_normals(
    samples: Samples, V: FloatArray, F: IntArray, N: FloatArray, camera: Camera
) -> tuple[FloatArray, BoolArray]:
    """Return the normals of the side that is seen.

    Parameters
    ----------
    samples : Samples
        Where.
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Triangles.
    N : (m, 3, 3) float
        Corner normals.
    camera : Camera
        Point of view.

    Returns
    -------
    normals : (k, 3) ndarray of float64
        Unit, interpolated.
    back : (k,) ndarray of bool
        Whether the back of the triangle is seen.
    """
    T = V[F[samples.face]]
    flat = np.cross(T[:, 1] - T[:, 0], T[:, 2] - T[:, 0])
    view = camera.position - samples.position if camera.fov else camera.axes[2]
    back = (flat * view).sum(axis=1) < 0
    n = np.einsum("kc,kcd->kd", samples.weights, N[samples.face])
    length = np.linalg.norm(n, axis=1, keepdims=True)
    n = np.where(length > 1e-12, n / np.maximum(length, 1e-12), camera.axes[2])
    return np.where(back[:, None], -n, n), back


def bulged(samples: Samples, V: FloatArray, F: IntArray, N: FloatArray, normals: FloatArray) -> FloatArray:
    """Move sample positions out to the smooth surface that the normals pretend.

    Without it a coarse mesh throws the shadow of its flat faces onto itself along the terminator.

    Parameters
    ----------
    samples : Samples
        Where.
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Triangles.
    N : (m, 3, 3) float
        Corner normals.
    normals : (k, 3) float
        Normals of the side that is seen.

    Returns
    -------
    (k, 3) ndarray of float64
        Positions, metres.

    References
    ----------
    .. [1] Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
    """
    corner, n = V[F[samples.face]], N[samples.face]
    n = n * np.sign(np.einsum("kcd,kd->kc", n, normals))[:, :, None]
    below = np.minimum(np.einsum("kcd,kcd->kc", samples.position[:, None] - corner, n), 0.0)
    return samples.position - np.einsum("kc,kc,kcd->kd", samples.weights, below, n)


def light_samples(samples: Samples, position: FloatArray, normals: FloatArray, lights: Lights) -> FloatArray:
    """Return the light at every sample; samples of one pixel on one surface share it.

    Parameters
    ----------
    samples : Samples
        Where.
    position : (k, 3) float
        Points to start from, metres.
    normals : (k, 3) float
        Unit normals of the side that is seen.
    lights : Lights
        Light and what is in its way.

    Returns
    -------
    (k, 3) ndarray of float64
        As `tempose.render.gather.gather`.
    """
    light = np.zeros((len(position), 3))
    _light_samples(samples.pixel, samples.depth, position, normals, light, *light_arrays(lights))
    return light


@njit(cache=True, nogil=True)
def _light_samples(pixel, depth, points, normals, light, dirs, weights, kind, frames, maps, offset):  # type: ignore[no-untyped-def]
    first = 0
    for k in range(len(points)):
        if k == 0 or pixel[k] != pixel[k - 1]:
            first = k
        n, found = normals[k], False
        for j in range(first, k):
            m = normals[j]
            same = n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.97
            if same and abs(depth[j] - depth[k]) < 0.004 * abs(depth[k]):
                light[k] = light[j]
                found = True
                break
        if not found:
            p = points[k]
            key, sky, bounce = gather_at(
                p[0], p[1], p[2], n[0], n[1], n[2], dirs, weights, kind, frames, maps, offset
            )
            light[k, 0], light[k, 1], light[k, 2] = key, sky, bounce
