"""What is seen of a mesh: position, normal and weights at every covered sample, and the light there."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numba import njit

from tempose.render.camera import Camera
from tempose.render.raster import rasterise
from tempose.typing import BoolArray, FloatArray, IntArray

_BAND = 400_000  # Samples shaded at a time: bounds the memory of large pictures.


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a picture that a triangle covers, in the order of their pixels."""

    pixel: IntArray
    """(k,) int64 pixel of each sample, row times width plus column."""
    face: IntArray
    """(k,) int32 triangle of each sample."""
    weights: FloatArray
    """(k, 3) float64 barycentric coordinates in the world."""
    edge: FloatArray
    """(k,) float64 distance to the nearest edge of the triangle that counts, pixels."""
    position: FloatArray
    """(k, 3) float64, metres."""
    smooth_position: FloatArray
    """(k, 3) float64, metres: moved out to the tangent planes of the corners [1]_.

    Without it a coarse mesh throws the shadow of its flat faces onto itself along the terminator.

    .. [1] Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
    """
    normal: FloatArray
    """(k, 3) float64 unit normal of the side that is seen, interpolated."""
    view: FloatArray
    """(k, 3) float64 unit vector towards the eye."""
    back: BoolArray
    """(k,) whether the back of the triangle is seen."""
    depth: FloatArray
    """(k,) float64 metres before the eye."""


def trace(
    V: FloatArray,
    F: IntArray,
    N: FloatArray,
    camera: Camera,
    size: tuple[int, int],
    s: int,
    edges: BoolArray | None = None,
) -> Iterator[Samples]:
    """Find what the samples of a picture see, band by band from the top.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Triangles; those that reach behind the eye are left out.
    N : (m, 3, 3) float
        Corner normals.
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.
    s : int
        Samples per pixel along each axis.
    edges : (m, 3) bool, optional
        Which edges count for `Samples.edge`, each named by the corner across; else all.

    Yields
    ------
    Samples
        The covered samples of some rows.
    """
    width, height = size
    P = screen(V, camera, (width * s, height * s))
    face, _ = rasterise(P, F, width * s, height * s)
    rows = max(_BAND // (width * s * s), 1)
    counted = np.ones(F.shape, np.bool_) if edges is None else edges
    parallel = camera.fov == 0
    eye = camera.axes[2] if parallel else camera.position
    for top in range(0, height, rows):
        band = face[top * s : (top + rows) * s]
        k = int(np.count_nonzero(band >= 0))
        if k == 0:
            continue
        out = Samples(
            np.zeros(k, np.int64),
            np.zeros(k, np.int32),
            *(np.zeros((k, 3)), np.zeros(k), np.zeros((k, 3)), np.zeros((k, 3)), np.zeros((k, 3))),
            *(np.zeros((k, 3)), np.zeros(k, np.bool_), np.zeros(k)),
        )
        _interpolate(
            band, top, s, P, V, F, N, counted, parallel, eye, out.pixel, out.face, out.weights, out.edge,
            out.position, out.smooth_position, out.normal, out.view, out.back,
        )  # fmt: skip
        out.depth[:] = (camera.position - out.position) @ camera.axes[2]
        yield out


def screen(V: FloatArray, camera: Camera, size: tuple[int, int]) -> FloatArray:
    """Project vertices for `tempose.render.raster.rasterise`.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.

    Returns
    -------
    (n, 3) ndarray of float64
        x, y in pixels and nearness; NaN behind the eye.
    """
    P = camera.project(V, size)
    if camera.fov == 0:
        P[:, 2] *= -1
        return P
    near = 1e-4 * float(np.abs(P[:, 2]).max(initial=1e-9))
    ahead = P[:, 2] > near
    P[:, 2] = 1.0 / np.where(ahead, P[:, 2], 1.0)
    P[~ahead] = np.nan
    return P


@njit(cache=True, nogil=True)
def _interpolate(
    faces,
    top,
    s,
    P,
    V,
    F,
    N,
    counted,
    parallel,
    eye,
    pixel,
    face,
    weights,
    edge,
    position,
    smooth,
    normal,
    view,
    back,
):
    height, width = faces.shape[0] // s, faces.shape[1] // s
    k = 0
    for j in range(height):
        for i in range(width):
            for sub in range(s * s):
                y, x = j * s + sub // s, i * s + sub % s
                f = faces[y, x]
                if f < 0:
                    continue
                pixel[k], face[k] = (top + j) * width + i, f
                edge[k] = _weights(P, F, f, counted, x + 0.5, top * s + y + 0.5, parallel, weights, k) / s
                for c in range(3):
                    for d in range(3):
                        position[k, d] += weights[k, c] * V[F[f, c], d]
                        normal[k, d] += weights[k, c] * N[f, c, d]
                back[k] = _turn(V, F, f, parallel, eye, position, normal, view, k)
                _bulge(V, F, f, N, weights, position, normal, smooth, k)
                k += 1


@njit(cache=True, nogil=True)
def _weights(P, F, f, counted, x, y, parallel, weights, k):
    # Corners are snapped to 1/256 pixel when drawn: clip what this leaves outside the triangle.
    a, b, c = F[f, 0], F[f, 1], F[f, 2]
    ax, ay, bx, by, cx, cy = P[a, 0], P[a, 1], P[b, 0], P[b, 1], P[c, 0], P[c, 1]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    scale = 1.0 / area if area != 0.0 else 0.0
    wb = max(((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) * scale, 0.0)
    wc = max(((bx - ax) * (y - ay) - (by - ay) * (x - ax)) * scale, 0.0)
    wa = max(1.0 - wb - wc, 0.0)
    edge = abs(area) * min(
        wa / max(np.hypot(cx - bx, cy - by), 1e-9) if counted[f, 0] else np.inf,
        wb / max(np.hypot(ax - cx, ay - cy), 1e-9) if counted[f, 1] else np.inf,
        wc / max(np.hypot(bx - ax, by - ay), 1e-9) if counted[f, 2] else np.inf,
    )
    if not parallel:
        wa, wb, wc = wa * P[a, 2], wb * P[b, 2], wc * P[c, 2]
    total = wa + wb + wc
    weights[k, 0], weights[k, 1], weights[k, 2] = wa / total, wb / total, wc / total
    return edge


@njit(cache=True, nogil=True)
def _turn(V, F, f, parallel, eye, position, normal, view, k):
    # Turn the normal to the side that is seen; say whether that is the back.
    a, b, c = F[f, 0], F[f, 1], F[f, 2]
    ux, uy, uz = V[b, 0] - V[a, 0], V[b, 1] - V[a, 1], V[b, 2] - V[a, 2]
    vx, vy, vz = V[c, 0] - V[a, 0], V[c, 1] - V[a, 1], V[c, 2] - V[a, 2]
    length = normal_length = 0.0
    for d in range(3):
        view[k, d] = eye[d] if parallel else eye[d] - position[k, d]
        length += view[k, d] ** 2
        normal_length += normal[k, d] ** 2
    length, normal_length = np.sqrt(length), np.sqrt(normal_length)
    for d in range(3):
        view[k, d] /= length
    facing = (uy * vz - uz * vy) * view[k, 0] + (uz * vx - ux * vz) * view[k, 1]
    facing += (ux * vy - uy * vx) * view[k, 2]
    side = -1.0 if facing < 0.0 else 1.0
    for d in range(3):
        normal[k, d] = side * normal[k, d] / normal_length if normal_length > 1e-12 else view[k, d]
    return facing < 0.0


@njit(cache=True, nogil=True)
def _bulge(V, F, f, N, weights, position, normal, smooth, k):
    for d in range(3):
        smooth[k, d] = position[k, d]
    for c in range(3):
        agrees = below = 0.0
        for d in range(3):
            agrees += N[f, c, d] * normal[k, d]
            below += (position[k, d] - V[F[f, c], d]) * N[f, c, d]
        side = 1.0 if agrees > 0.0 else -1.0
        if side * below < 0.0:
            for d in range(3):
                smooth[k, d] -= weights[k, c] * below * N[f, c, d]
