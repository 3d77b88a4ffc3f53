"""One picture of one mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.render.camera import Camera
from tempose.render.colors import Picture, as_colors, to_linear, to_srgb
from tempose.render.ground import floor_picture
from tempose.render.lights import Lights, Quality, make_lights, quality_named
from tempose.render.normals import corner_normals
from tempose.render.overlay import draw_segments
from tempose.render.surface import Samples, bulged, light_samples, oriented_normals, trace
from tempose.render.themes import Theme, rgb, theme_named
from tempose.typing import FloatArray, IntArray

KEY_LIGHT = (-0.62, 0.74, 0.62)
"""Towards the key light in the axes of the camera: from the upper left, over the viewer's shoulder."""


@dataclass(frozen=True)
class _Balance:
    # Share of each light in what a white surface sends back, and the sheen of the key light.
    key: float = 0.80
    sky: float = 0.42
    bounce: float = 0.16
    sheen: float = 0.05


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
    wire: bool = False,
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
    wire : bool, default False
        Whether to draw the edges of the triangles.
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
    V = as_floats(V, "V", ("n", 3))
    F = as_indices(F, "F", ("m", 3), limit=len(V))
    width, height = _checked_size(size)
    tone, work = theme_named(theme), quality_named(quality)
    samples = trace(V, F, camera, (width, height), work.samples)
    lights = make_lights(V, F, key_direction(camera), work) if lit else None
    albedo = _albedo(samples, V, F, colors, face_colors, tone)
    if checker:
        albedo = _chequered(albedo, samples, F, uv, uv_faces, checker, len(V))
    shaded = _shaded(samples, V, F, albedo, camera, lights, crease, tone if show_back else None)
    if wire:
        shaded = _wired(shaded, samples, F, work.samples, tone)
    picture, depth = _composed(samples, shaded, V, camera, lights, ground, tone)
    _overlaid(picture, depth, camera, (width, height), lines, line_colors, line_width, "lines", tone.held)
    spots = None if points is None else np.repeat(np.asarray(points, dtype=float)[:, None], 2, axis=1)
    _overlaid(picture, depth, camera, (width, height), spots, point_colors, point_size, "points", tone.held)
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


def _albedo(
    samples: Samples, V: FloatArray, F: IntArray, colors: Any, face_colors: Any, tone: Theme
) -> FloatArray:
    if face_colors is not None:
        return to_linear(as_colors(face_colors, "face_colors", len(F)))[samples.face]
    if colors is None or isinstance(colors, str):
        return np.tile(to_linear(rgb(colors or tone.mesh)), (len(samples.face), 1))
    corner = to_linear(as_colors(colors, "colors", len(V)))[F[samples.face]]
    return np.einsum("kc,kcd->kd", samples.weights, corner)


def _chequered(
    albedo: FloatArray, samples: Samples, F: IntArray, uv: Any, uv_faces: Any, squares: int, n: int
) -> FloatArray:
    if uv is None:
        raise ValueError("checker needs uv, got None")
    uv = as_floats(uv, "uv", (n if uv_faces is None else "k", 2))
    G = F if uv_faces is None else as_indices(uv_faces, "uv_faces", (len(F), 3), limit=len(uv))
    at = np.einsum("kc,kcd->kd", samples.weights, uv[G[samples.face]]) * squares
    odd = (np.floor(at).sum(axis=1).astype(np.int64) % 2).astype(bool)
    return np.where(odd[:, None], albedo * 0.35, albedo)


def _shaded(
    samples: Samples,
    V: FloatArray,
    F: IntArray,
    albedo: FloatArray,
    camera: Camera,
    lights: Lights | None,
    crease: float | None,
    tint: Theme | None,
) -> FloatArray:
    N = corner_normals(V, F, crease)
    normals, back = oriented_normals(samples, V, F, N, camera)
    if tint is not None:
        albedo = np.where(back[:, None], to_linear(rgb(tint.back)), albedo)
    if lights is None:
        return albedo
    balance = _Balance()
    start = bulged(samples, V, F, N, normals)
    key, sky, bounce = light_samples(samples, start, normals, lights).T
    d = key_direction(camera)
    view = (
        camera.position - samples.position if camera.fov else np.broadcast_to(camera.axes[2], normals.shape)
    )
    half = d + view / np.linalg.norm(view, axis=1, keepdims=True)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    diffuse = balance.key * key * np.maximum(normals @ d, 0) + balance.sky * sky + balance.bounce * bounce
    # A back face is often deep inside: it keeps a light of its own, or the warning would be black.
    diffuse = np.where(back & (tint is not None), np.maximum(diffuse, 0.45), diffuse)
    sheen = balance.sheen * key * np.maximum((normals * half).sum(axis=1), 0) ** 24
    return albedo * diffuse[:, None] + sheen[:, None]


def _wired(shaded: FloatArray, samples: Samples, F: IntArray, s: int, tone: Theme) -> FloatArray:
    P = samples.projected[F[samples.face], :2]
    edge = np.roll(P, -1, axis=1) - np.roll(P, 1, axis=1)
    area = np.abs(edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0])
    length = np.maximum(np.linalg.norm(edge, axis=2), 1e-9)
    distance = (samples.screen_weights * area[:, None] / length).min(axis=1) / s
    cover = 0.7 * np.clip(0.9 - distance, 0.0, 1.0)[:, None]
    return shaded + cover * (to_linear(rgb(tone.wire)) - shaded)


def _composed(
    samples: Samples,
    shaded: FloatArray,
    V: FloatArray,
    camera: Camera,
    lights: Lights | None,
    ground: float | None,
    tone: Theme,
) -> tuple[FloatArray, FloatArray]:
    width, height = samples.size
    behind = np.tile(to_linear(rgb(tone.view)), (width * height, 1))
    floor_depth = np.full(width * height, np.inf)
    if ground is not None:
        low, high = (V.min(axis=0), V.max(axis=0)) if len(V) else (np.full(3, -1.0), np.full(3, 1.0))
        extent = max(float(np.linalg.norm(high - low)), 1e-6)
        behind, floor_depth = floor_picture(
            camera, samples.size, float(ground), lights, tone, (low + high) / 2, extent
        )
    # What has sunk into the floor stays visible, but faint.
    sunk = samples.depth > floor_depth[samples.pixel] + 1e-3 * np.abs(samples.depth)
    shaded = np.where(sunk[:, None], 0.4 * shaded + 0.6 * behind[samples.pixel], shaded)
    covered = np.bincount(samples.pixel, minlength=width * height)
    total = np.stack(
        [np.bincount(samples.pixel, shaded[:, c], minlength=width * height) for c in range(3)], axis=1
    )
    empty = 1 - covered[:, None] / samples.per_pixel
    depth = np.full(width * height, np.inf)
    np.minimum.at(depth, samples.pixel, samples.depth)
    picture = total / samples.per_pixel + empty * behind
    return picture.reshape(height, width, 3), depth.reshape(height, width)


def _overlaid(
    picture: FloatArray,
    depth: FloatArray,
    camera: Camera,
    size: tuple[int, int],
    ends: Any,
    colors: Any,
    width: float,
    name: str,
    default: str,
) -> None:
    if ends is None:
        return
    E = np.asarray(ends, dtype=np.float64)
    if E.ndim != 3 or E.shape[1:] != (2, 3):
        shape = "(k, 2, 3)" if name == "lines" else "(p, 3)"
        raise ValueError(f"{name} must have shape {shape}, got {np.shape(ends)}")
    known = np.isfinite(E).all(axis=(1, 2))
    P = camera.project(np.where(known[:, None, None], E, 0.0).reshape(-1, 3), size).reshape(-1, 2, 3)
    P[~known] = np.nan
    ink = to_linear(as_colors(default if colors is None else colors, f"{name[:-1]}_colors", len(E)))
    draw_segments(picture, depth, P, ink, width / 2)
