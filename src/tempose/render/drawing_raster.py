"""Drawings as pixels: every line covers each pixel once, so that edges are smooth at any width."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.render.colors import Picture, as_colors
from tempose.render.dashes import dashed
from tempose.render.drawing import Drawing, Inset, Patch, Stroke, Words
from tempose.render.text import font_of, pillow
from tempose.render.themes import rgb
from tempose.typing import FloatArray


def drawing_picture(drawing: Drawing, scale: float = 2.0) -> Picture:
    """Draw a drawing.

    Parameters
    ----------
    drawing : Drawing
        What to draw.
    scale : float, default 2
        Pixels for each pixel of the drawing.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    size = (round(drawing.height * scale), round(drawing.width * scale))
    picture = np.tile(rgb(drawing.background), (*size, 1))
    words: list[Words] = []
    for shape in drawing.shapes:
        if isinstance(shape, Words):
            words.append(shape)  # over everything: nothing may cross them out
        elif isinstance(shape, Inset):
            _put(picture, shape, scale)
        elif isinstance(shape, Patch):
            points = scale * np.asarray(shape.points, dtype=np.float64)
            _fill(picture, _counter_clockwise(points), as_colors(shape.color, "color", 1)[0], shape.opacity)
        else:
            _draw_stroke(picture, shape, scale)
    image = pillow().Image.fromarray(np.round(np.clip(picture, 0.0, 1.0) * 255).astype(np.uint8))
    pen = pillow().ImageDraw.Draw(image)
    for text in words:
        _write(pen, text, scale)
    return np.asarray(image)


def _draw_stroke(picture: FloatArray, shape: Stroke, scale: float) -> None:
    radius = 0.5 * shape.width * scale
    points = scale * np.asarray(shape.points, dtype=np.float64)
    low, high = points.min(axis=0) - radius - 2, points.max(axis=0) + radius + 3
    x0, y0 = (max(int(v), 0) for v in low)
    part = picture[y0 : max(int(high[1]), 0), x0 : max(int(high[0]), 0)]
    covered, color = np.zeros(part.shape[:2]), np.zeros(part.shape)
    for piece, colors in dashed(points - [x0, y0], shape.colors, [scale * d for d in shape.dash]):
        _cover(covered, color, piece, colors, radius)
    alpha = (shape.opacity * covered)[..., None]
    part += alpha * (color - part)


@njit(cache=True, nogil=True)
def _cover(covered, ink, points, colors, radius):
    height, width = covered.shape
    for k in range(max(len(points) - 1, 1)):
        a, b = points[k], points[min(k + 1, len(points) - 1)]
        x0, x1 = max(int(min(a[0], b[0]) - radius - 1), 0), min(int(max(a[0], b[0]) + radius + 2), width)
        y0, y1 = max(int(min(a[1], b[1]) - radius - 1), 0), min(int(max(a[1], b[1]) + radius + 2), height)
        dx, dy = b[0] - a[0], b[1] - a[1]
        length2 = dx * dx + dy * dy
        for j in range(y0, y1):
            for i in range(x0, x1):
                px, py = i + 0.5 - a[0], j + 0.5 - a[1]
                t = 0.0 if length2 == 0.0 else min(max((px * dx + py * dy) / length2, 0.0), 1.0)
                distance = np.sqrt((px - t * dx) ** 2 + (py - t * dy) ** 2)
                alpha = min(max(radius + 0.5 - distance, 0.0), 1.0) * min(2 * radius, 1.0)
                if alpha > 0.0 and alpha >= covered[j, i]:  # the later part of a line is on top
                    covered[j, i] = alpha
                    for c in range(3):
                        ink[j, i, c] = (1 - t) * colors[k, c] + t * colors[min(k + 1, len(colors) - 1), c]


def _counter_clockwise(points: FloatArray) -> FloatArray:
    after = np.roll(points, -1, axis=0)
    area = float((points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]).sum())
    return np.ascontiguousarray(points if area > 0 else points[::-1])


@njit(cache=True, nogil=True)
def _fill(picture, points, color, opacity):
    height, width = picture.shape[:2]
    x0, x1 = max(int(points[:, 0].min() - 1), 0), min(int(points[:, 0].max() + 2), width)
    y0, y1 = max(int(points[:, 1].min() - 1), 0), min(int(points[:, 1].max() + 2), height)
    n = len(points)
    for j in range(y0, y1):
        for i in range(x0, x1):
            alpha = 1.0
            for k in range(n):
                a, b = points[k], points[(k + 1) % n]
                ex, ey = b[0] - a[0], b[1] - a[1]
                length = np.sqrt(ex * ex + ey * ey)
                if length > 0:
                    inside = (ex * (j + 0.5 - a[1]) - ey * (i + 0.5 - a[0])) / length
                    alpha = min(alpha, min(max(inside + 0.5, 0.0), 1.0))
            for c in range(3):
                picture[j, i, c] += opacity * alpha * (color[c] - picture[j, i, c])


def _put(picture: FloatArray, inset: Inset, scale: float) -> None:
    width, height = (max(round(s * scale), 1) for s in inset.size)
    Image = pillow().Image
    image = np.asarray(inset.picture)
    # colours weighted by opacity while they are averaged: what is transparent has none
    alpha = image[..., 3:] / 255.0
    part = np.concatenate([image[..., :3] / 255.0 * alpha, alpha], axis=2)
    if (width, height) != (image.shape[1], image.shape[0]):
        planes = [Image.fromarray(part[..., c].astype(np.float32)) for c in range(4)]
        part = np.stack([np.asarray(p.resize((width, height), Image.Resampling.BOX)) for p in planes], axis=2)
    left, top = round(inset.at[0] * scale - width / 2), round(inset.at[1] * scale - height / 2)
    rows = slice(max(top, 0), min(top + height, picture.shape[0]))
    columns = slice(max(left, 0), min(left + width, picture.shape[1]))
    if rows.start < rows.stop and columns.start < columns.stop:
        part = part[rows.start - top : rows.stop - top, columns.start - left : columns.stop - left]
        picture[rows, columns] = picture[rows, columns] * (1 - part[..., 3:]) + part[..., :3]


def _write(pen: Any, words: Words, scale: float) -> None:
    anchor = {"start": "l", "middle": "m", "end": "r"}[words.anchor] + "m"
    rim = {"stroke_width": max(round(scale), 1), "stroke_fill": words.halo} if words.halo else {}
    pen.text(
        (words.at[0] * scale, words.at[1] * scale),
        words.text,
        fill=words.color,
        font=font_of(max(round(words.size * scale), 1)),
        anchor=anchor,
        **rim,
    )
