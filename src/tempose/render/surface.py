"""What is seen of a mesh: position, normal and weights at every covered sample, and the light there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tempose.render.camera import Camera
from tempose.render.interpolate import interpolate
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
        interpolate(
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
