"""Segments and points over a picture: bones, markers, marks; fainter where the surface hides them."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.render.camera import Camera
from tempose.render.colors import as_colors, to_linear
from tempose.typing import FloatArray


def overlaid(
    picture: FloatArray,
    depth: FloatArray,
    camera: Camera,
    ends: Any,
    colors: Any,
    width: float,
    name: str,
    default: str,
) -> None:
    """Draw the segments or points of `tempose.render.render_frame` into a picture.

    Parameters
    ----------
    picture : (height, width, 3) float64
        Linear light; written.
    depth : (height, width) float64
        Metres before the eye, infinite where nothing is.
    camera : Camera
        Point of view.
    ends : (k, 2, 3) array_like, optional
        Metres.
    colors : (k, 3) or (3,) array_like or str, optional
        sRGB, 0 to 1.
    width : float
        Pixels.
    name : str
        ``"lines"`` or ``"points"``, for messages.
    default : str
        Colour if none is given.

    Raises
    ------
    ValueError
        If a shape is another.
    """
    if ends is None:
        return
    E = np.asarray(ends, dtype=np.float64)
    if E.ndim != 3 or E.shape[1:] != (2, 3):
        shape = "(k, 2, 3)" if name == "lines" else "(p, 3)"
        raise ValueError(f"{name} must have shape {shape}, got {np.shape(ends)}")
    size = (depth.shape[1], depth.shape[0])
    P = camera.project(np.where(np.isfinite(E), E, 0.0).reshape(-1, 3), size).reshape(-1, 2, 3)
    P[~np.isfinite(E).all(axis=(1, 2))] = np.nan
    ink = to_linear(as_colors(default if colors is None else colors, f"{name[:-1]}_colors", len(E)))
    draw_segments(picture, depth, P, ink, width / 2)


def draw_segments(
    picture: FloatArray,
    depth: FloatArray,
    ends: FloatArray,
    colors: FloatArray,
    radius: float,
    hidden: float = 0.45,
) -> None:
    """Draw segments with round ends into a picture.

    Parameters
    ----------
    picture : (height, width, 3) float64
        Linear light; written.
    depth : (height, width) float64
        Metres before the eye of what is there, infinite where nothing is.
    ends : (k, 2, 3) float64
        Ends: x, y in pixels and depth in metres. Those of a point coincide. Left out where NaN or
        behind the eye.
    colors : (k, 3) float64
        Linear light.
    radius : float
        Half the width, pixels.
    hidden : float, default 0.45
        Opacity where the surface is in front.
    """
    far_first = np.argsort(-np.nan_to_num(ends[:, :, 2].mean(axis=1)), kind="stable")
    for k in far_first:
        a, b = ends[k]
        if np.isfinite(ends[k]).all() and min(a[2], b[2]) > 0:
            _draw(picture, depth, a, b, colors[k], radius, hidden)


@njit(cache=True, nogil=True)
def _draw(picture, depth, a, b, color, radius, hidden):
    height, width = depth.shape
    x0 = max(int(min(a[0], b[0]) - radius - 1), 0)
    x1 = min(int(max(a[0], b[0]) + radius + 2), width)
    y0 = max(int(min(a[1], b[1]) - radius - 1), 0)
    y1 = min(int(max(a[1], b[1]) + radius + 2), height)
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    for j in range(y0, y1):
        for i in range(x0, x1):
            px, py = i + 0.5 - a[0], j + 0.5 - a[1]
            t = 0.0 if length2 == 0.0 else min(max((px * dx + py * dy) / length2, 0.0), 1.0)
            distance = np.sqrt((px - t * dx) ** 2 + (py - t * dy) ** 2)
            alpha = min(max(radius + 0.5 - distance, 0.0), 1.0)
            if alpha == 0.0:
                continue
            if a[2] + t * (b[2] - a[2]) > depth[j, i]:
                alpha *= hidden
            for c in range(3):
                picture[j, i, c] += alpha * (color[c] - picture[j, i, c])
