"""One picture of one mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.render.camera import Camera
from tempose.render.colors import Picture, to_linear, to_srgb
from tempose.render.floor import floor_picture
from tempose.render.lights import Lights, Quality, make_lights, quality_named
from tempose.render.normals import corner_normals
from tempose.render.overlay import overlaid
from tempose.render.paint import Paint, blend
from tempose.render.surface import trace
from tempose.render.themes import Theme, rgb, theme_named
from tempose.typing import BoolArray, FloatArray

KEY_LIGHT = (-0.72, 0.70, 0.42)
"""Towards the key light in the axes of the camera: from the upper left, over the viewer's shoulder."""


def render_frame(
    V: Any,
    F: Any,
    camera: Camera,
    *,
    size: tuple[int, int] = (640, 640),
    colors: Any = None,
    face_colors: Any = None,
    uv: Any = None,
    uv_faces: Any = None,
    checker: int = 0,
    lines: Any = None,
    line_colors: Any = None,
    points: Any = None,
    point_colors: Any = None,
    line_width: float = 2.5,
    point_size: float = 7.0,
    theme: str | Theme = "light",
    ground: float | None = None,
    wire: Any = False,
    crease: float | None = None,
    lit: bool = True,
    show_back: bool = True,
    quality: str | Quality = "good",
) -> Picture:
    """Render a mesh like a plaster model in a studio: soft shadows and ambient occlusion.

    Parameters
    ----------
    V : (n, 3) array_like
        Vertices, metres.
    F : (m, 3) array_like of int
        Triangles, counter-clockwise seen from outside.
    camera : Camera
        Point of view, for instance from `Camera.fit`.
    size : (int, int), default (640, 640)
        Width and height, pixels.
    colors : (n, 3) or (3,) array_like or str, optional
        sRGB from 0 to 1 per vertex, or one for all.
    face_colors : (m, 3) array_like, optional
        sRGB from 0 to 1 per triangle; takes the place of `colors`.
    uv : (k, 2) array_like, optional
        Texture coordinates, for `checker`.
    uv_faces : (m, 3) array_like of int, optional
        Triangles of `uv`; without it uv follows the vertices.
    checker : int, default 0
        Squares of a chequerboard along each axis of `uv`; it shows stretch and shear.
    lines : (k, 2, 3) array_like, optional
        Segments drawn over the picture, metres, such as bones; fainter where hidden; NaN leaves one out.
    line_colors : (k, 3) or (3,) array_like or str, optional
        Their colours.
    points : (p, 3) array_like, optional
        Points drawn over the picture, metres, such as markers; NaN leaves one out.
    point_colors : (p, 3) or (3,) array_like or str, optional
        Their colours.
    line_width, point_size : float
        Pixels.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    ground : float, optional
        Height of a floor with shadows and a grid, metres; None for no floor.
    wire : bool or (m, 3) array_like of bool, default False
        Whether to draw the edges of the triangles; or which, each edge named by the corner across from it.
    crease : float, optional
        Radians: edges sharper than this are shaded sharp. None smooths everything.
    lit : bool, default True
        False paints plain colours without light and floor shadows.
    show_back : bool, default True
        Whether back faces get a warning tint.
    quality : str or Quality, default "good"
        ``"draft"``, ``"good"`` or ``"best"``.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture, row 0 at the top. Deterministic.

    Raises
    ------
    ValueError
        If an argument has another shape, is not finite or out of range.
    """
    # Copies: compiled code would be compiled once more for arrays that refuse writes.
    V = np.array(as_floats(V, "V", ("n", 3)), order="C")
    F = np.array(as_indices(F, "F", ("m", 3), limit=len(V)), order="C")
    width, height = _checked_size(size)
    tone, work = theme_named(theme), quality_named(quality)
    N = corner_normals(V, F, crease)
    lights = make_lights(V, F, key_direction(camera), work) if lit else None
    edges = _wired(wire, len(F))
    paint = Paint.checked(
        V, F, colors, face_colors, uv, uv_faces, checker, edges is not None, show_back, tone
    )
    behind, floor_depth = _background(V, camera, (width, height), lights, ground, tone, work)
    picture, depth = behind.copy(), np.full(width * height, np.inf)
    for samples in trace(V, F, N, camera, (width, height), work.samples, edges):
        shaded = paint.shaded(samples, key_direction(camera), lights)
        # What has sunk into the floor stays visible, but faint.
        sunk = samples.depth > floor_depth[samples.pixel] + 1e-3 * np.abs(samples.depth)
        shaded[sunk] = 0.4 * shaded[sunk] + 0.6 * behind[samples.pixel[sunk]]
        blend(picture, depth, samples.pixel, samples.depth, shaded, work.samples**2)
    picture, depth = picture.reshape(height, width, 3), depth.reshape(height, width)
    overlaid(picture, depth, camera, lines, line_colors, line_width, "lines", tone.held)
    spots = None if points is None else np.repeat(np.asarray(points, dtype=float)[:, None], 2, axis=1)
    overlaid(picture, depth, camera, spots, point_colors, point_size, "points", tone.held)
    return np.round(to_srgb(picture) * 255).astype(np.uint8)


def key_direction(camera: Camera) -> FloatArray:
    """Return the direction of the key light: upper left of the viewer, never from below.

    Parameters
    ----------
    camera : Camera
        Point of view.

    Returns
    -------
    (3,) ndarray of float64
        Unit vector towards the light.
    """
    d = np.array(KEY_LIGHT) @ camera.axes
    d /= np.linalg.norm(d)
    d[1] = max(d[1], 0.45)
    return d / np.linalg.norm(d)


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(x) for x in size)
    if not (1 <= width <= 8192 and 1 <= height <= 8192):
        raise ValueError(f"size must be width and height from 1 to 8192 pixels, got {size}")
    return width, height


def _wired(wire: Any, m: int) -> BoolArray | None:
    if isinstance(wire, (bool, np.bool_)):
        return np.ones((m, 3), dtype=np.bool_) if wire else None
    edges = np.array(wire, dtype=np.bool_)
    if edges.shape != (m, 3):
        raise ValueError(f"wire must be True, False or of shape ({m}, 3), got {edges.shape}")
    return edges


def _background(
    V: FloatArray,
    camera: Camera,
    size: tuple[int, int],
    lights: Lights | None,
    ground: float | None,
    tone: Theme,
    work: Quality,
) -> tuple[FloatArray, FloatArray]:
    count = size[0] * size[1]
    if ground is None:
        return np.tile(to_linear(rgb(tone.view)), (count, 1)), np.full(count, np.inf)
    if not np.isfinite(ground):
        raise ValueError(f"ground must be a height in metres or None, got {ground}")
    box = np.stack([V.min(axis=0), V.max(axis=0)]) if len(V) else np.array([[-1.0] * 3, [1.0] * 3])
    return floor_picture(camera, size, float(ground), lights, tone, box, stride=1 if work.samples > 2 else 2)
