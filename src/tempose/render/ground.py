"""The floor under a model: shadows on it, and a grid by which a sliding foot is seen."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.render.camera import Camera
from tempose.render.colors import to_linear
from tempose.render.gather import gather_at, light_arrays
from tempose.render.lights import Lights
from tempose.render.themes import Theme, rgb
from tempose.typing import FloatArray


def grid_spacing(extent: float) -> tuple[float, float]:
    """Return the distance of the strong and the faint lines of the grid.

    Parameters
    ----------
    extent : float
        Size of what stands on it, metres.

    Returns
    -------
    (float, float)
        Metres: 1 and 0.2 for anything from 0.5 to 20 m, otherwise the power of ten that suits.
    """
    if 0.5 <= extent <= 20:
        return 1.0, 0.2
    strong = 10.0 ** np.floor(np.log10(max(extent, 1e-9)))
    return float(strong), float(strong / 5)


def intersect(camera: Camera, size: tuple[int, int], level: float) -> tuple[FloatArray, FloatArray]:
    """Find where the line of sight of every pixel centre meets a level plane.

    Parameters
    ----------
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.
    level : float
        Height of the plane, metres.

    Returns
    -------
    points : (height * width, 3) ndarray of float64
        Metres; NaN where the plane is not met.
    depth : (height * width,) ndarray of float64
        Metres before the eye; infinite where it is not met.
    """
    width, height = size
    scale = camera.pixels_per_metre(size)
    x, y = np.meshgrid(
        (np.arange(width) + 0.5 - width / 2) / scale, (height / 2 - np.arange(height) - 0.5) / scale
    )
    across = x.reshape(-1, 1) * camera.axes[0] + y.reshape(-1, 1) * camera.axes[1]
    if camera.fov:
        origin, direction = camera.position[None], across - camera.axes[2]
    else:
        origin, direction = camera.position + across, -camera.axes[2][None]
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = (level - origin[:, 1]) / direction[:, 1]
        points = origin + depth[:, None] * direction
    met = np.isfinite(depth) & ((depth > 0) if camera.fov else True)
    return np.where(met[:, None], points, np.nan), np.where(met, depth, np.inf)


def floor_picture(
    camera: Camera,
    size: tuple[int, int],
    level: float,
    lights: Lights | None,
    theme: Theme,
    centre: FloatArray,
    extent: float,
) -> tuple[FloatArray, FloatArray]:
    """Paint the floor: lit near the model, fading into the background, with shadows and grid.

    Parameters
    ----------
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.
    level : float
        Height of the floor, metres.
    lights : Lights, optional
        What throws shadows.
    theme : Theme
        Colours.
    centre : (3,) float
        Middle of the model, metres.
    extent : float
        Size of the model, metres.

    Returns
    -------
    colour : (height * width, 3) ndarray of float64
        Linear light; the background where no floor is.
    depth : (height * width,) ndarray of float64
        Metres before the eye, infinite where no floor is.
    """
    view = to_linear(rgb(theme.view))
    points, depth = intersect(camera, size, level)
    away = np.nan_to_num(np.hypot(points[:, 0] - centre[0], points[:, 2] - centre[2]) / extent, nan=1e9)
    near, far = _falloff(away, 0.7, 1.9), _falloff(away, 1.0, 3.2)
    colour = view + near[:, None] * (to_linear(rgb(theme.floor)) - view)
    for spacing, code in zip(grid_spacing(extent)[::-1], (theme.line, theme.strong_line)):
        cover = _lines(points.reshape(size[1], size[0], 3), spacing).reshape(-1) * far
        colour += cover[:, None] * (to_linear(rgb(code)) - colour)
    if lights is not None:
        seen = far > 0
        shade = np.zeros(len(points))
        shade[seen] = _floor_shadow(points[seen], lights)
        colour *= 1 - theme.shadow * (shade * far)[:, None]
    return colour, np.where(far > 0, depth, np.inf)


def _floor_shadow(points: FloatArray, lights: Lights) -> FloatArray:
    light = np.zeros((len(points), 2))
    arrays = light_arrays(lights)
    _open_sky(np.ascontiguousarray(points), light, *arrays[:-1])
    return 1 - (0.55 * light[:, 0] + 0.45 * light[:, 1])


@njit(cache=True, nogil=True)
def _open_sky(points, light, dirs, weights, kind, frames, maps):  # type: ignore[no-untyped-def]
    for i in range(len(points)):
        p = points[i]
        key, sky, _ = gather_at(p[0], p[1], p[2], 0.0, 1.0, 0.0, dirs, weights, kind, frames, maps, 0.0)
        light[i, 0], light[i, 1] = key, sky


def _falloff(x: FloatArray, start: float, stop: float) -> FloatArray:
    t = np.clip((stop - x) / (stop - start), 0.0, 1.0)
    return t * t * (3 - 2 * t)


def _lines(points: FloatArray, spacing: float) -> FloatArray:
    # Coverage of lines one pixel wide; they vanish where cells come near the size of a pixel.
    cover = np.zeros(points.shape[:2])
    for axis in (0, 2):
        x = points[..., axis] / spacing
        step = np.hypot(*np.gradient(x)) if min(x.shape) > 1 else np.full(x.shape, np.nan)
        with np.errstate(invalid="ignore", divide="ignore"):
            distance = np.abs(x - np.round(x)) / step
            line = np.clip(1.0 - distance, 0.0, 1.0) * np.clip((0.25 - step) / 0.2, 0.0, 1.0)
        cover = np.maximum(cover, np.nan_to_num(line))
    return cover
