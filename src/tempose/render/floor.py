"""The floor under a model: shadows on it, and a grid by which a sliding foot is seen."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

import numpy as np
from numba import njit

from tempose.render.camera import Camera
from tempose.render.colors import to_linear
from tempose.render.floor_shadow import floor_shadow
from tempose.render.lights import Lights
from tempose.render.themes import Theme, rgb
from tempose.typing import FloatArray

REACH = 3.2
"""Where floor and grid have faded away, in sizes of the model from its middle."""


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

    Examples
    --------
    >>> grid_spacing(1.8)
    (1.0, 0.2)
    """
    if 0.5 <= extent <= 20:
        return 1.0, 0.2
    strong = 10.0 ** np.floor(np.log10(max(extent, 1e-9)))
    return float(strong), float(strong / 5)


def floor_picture(
    camera: Camera,
    size: tuple[int, int],
    level: float,
    lights: Lights | None,
    theme: Theme,
    box: FloatArray,
    stride: int = 2,
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
        What throws shadows; without it there are none.
    theme : Theme
        Colours.
    box : (2, 3) float
        Lower and upper corner of the model, metres.
    stride : int, default 2
        Shadows are computed in every so many pixels and row, and between these where they change.

    Returns
    -------
    colour : (height * width, 3) ndarray of float64
        Linear light; the background where no floor is.
    depth : (height * width,) ndarray of float64
        Metres before the eye, infinite where no floor is.
    """
    extent = max(float(np.linalg.norm(box[1] - box[0])), 1e-6)
    centre = box.mean(axis=0)
    spot, depth, faint, strong = floor_points(camera, size, level, grid_spacing(extent))
    away = np.hypot(spot[:, 0] - centre[0], spot[:, 1] - centre[2]) / extent
    depth[~(away < REACH)] = np.inf
    shade = np.zeros(len(spot))
    if lights is not None:
        shade = theme.shadow * floor_shadow(spot, level, lights, np.isfinite(depth), size, stride)
    tones = to_linear(np.stack([rgb(c) for c in (theme.view, theme.floor, theme.line, theme.strong_line)]))
    colour = np.zeros((len(spot), 3))
    _paint(away, faint, strong, shade, tones, colour)
    return colour, depth


@njit(cache=True, nogil=True)
def _paint(away, faint, strong, shade, tones, colour):
    for k in range(len(away)):
        near, far = _falloff(away[k], 0.7, 1.9), _falloff(away[k], 1.0, REACH)
        for c in range(3):
            x = tones[0, c] + near * (tones[1, c] - tones[0, c])
            x += faint[k] * far * (tones[2, c] - x)
            x += strong[k] * far * (tones[3, c] - x)
            colour[k, c] = x * (1.0 - shade[k] * far)


@njit(cache=True, nogil=True)
def _falloff(x, start, stop):
    if not x < stop:
        return 0.0
    t = min((stop - x) / (stop - start), 1.0)
    return t * t * (3.0 - 2.0 * t)


def floor_points(
    camera: Camera, size: tuple[int, int], level: float, spacing: tuple[float, float]
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Find where the line of sight of every pixel centre meets the floor, and the grid lines there.

    Parameters
    ----------
    camera : Camera
        Point of view.
    size : (int, int)
        Width and height, pixels.
    level : float
        Height of the floor, metres.
    spacing : (float, float)
        Distance of strong and of faint lines, metres.

    Returns
    -------
    spot : (height * width, 2) ndarray of float64
        x and z, metres; NaN where the floor is not met.
    depth : (height * width,) ndarray of float64
        Metres before the eye; infinite where it is not met.
    faint, strong : (height * width,) ndarray of float64
        Share of the pixel that a line covers.
    """
    width, height = size
    count = width * height
    spot, depth = np.full((count, 2), np.nan), np.full(count, np.inf)
    faint, strong = np.zeros(count), np.zeros(count)
    scale = camera.pixels_per_metre(size)
    _meet(
        width, height, scale, camera.fov == 0, camera.position, camera.axes, float(level),
        spacing[0], spacing[1], spot, depth, faint, strong,
    )  # fmt: skip
    return spot, depth, faint, strong


@njit(cache=True, nogil=True)
def _meet(width, height, scale, parallel, eye, axes, level, wide, narrow, spot, depth, faint, strong):
    moved = 1.0 if parallel else 0.0  # Pixels differ in origin (parallel) or in direction (perspective).
    turned = 1.0 - moved
    for j in range(height):
        y = (height / 2 - j - 0.5) / scale
        for i in range(width):
            x = (i + 0.5 - width / 2) / scale
            dy = turned * (x * axes[0, 1] + y * axes[1, 1]) - axes[2, 1]
            if abs(dy) < 1e-12:
                continue
            t = (level - eye[1] - moved * (x * axes[0, 1] + y * axes[1, 1])) / dy
            if t <= 0.0 and not parallel:
                continue
            k = j * width + i
            depth[k] = t
            # Along x and z: the place, and metres of floor per pixel to the right and per pixel down.
            reach = (1.0 if parallel else t) / scale
            for c in range(2):
                q = 2 * c
                across = x * axes[0, q] + y * axes[1, q]
                dq = turned * across - axes[2, q]
                spot[k, c] = eye[q] + moved * across + t * dq
                pixel = reach * np.hypot(axes[0, q] - axes[0, 1] * dq / dy, axes[1, q] - axes[1, 1] * dq / dy)
                faint[k] = max(faint[k], _line(spot[k, c], pixel, narrow))
                strong[k] = max(strong[k], _line(spot[k, c], pixel, wide))


@njit(cache=True, nogil=True)
def _line(x, pixel, spacing):
    # Lines one pixel wide; they vanish where their distance comes near a few pixels.
    distance = abs(x - spacing * np.round(x / spacing)) / pixel
    return max(1.0 - distance, 0.0) * min(max((0.25 - pixel / spacing) / 0.2, 0.0), 1.0)
