"""Drawings as SVG text."""

from __future__ import annotations

import base64
from html import escape
from io import BytesIO
from typing import Any

import numpy as np

from tempose.render.colors import as_colors
from tempose.render.drawing import Drawing, Inset, Patch, Shape, Stroke, Words
from tempose.render.text import pillow
from tempose.typing import FloatArray

_FONT = "Inter, system-ui, sans-serif"


def drawing_svg(drawing: Drawing) -> str:
    """Return a drawing as a file of SVG.

    Parameters
    ----------
    drawing : Drawing
        What to write.

    Returns
    -------
    str
        An ``<svg>`` element that stands alone; all words are escaped.
    """
    width, height = drawing.width, drawing.height
    body = "\n".join(_element(shape) for shape in drawing.shapes)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="{_FONT}">\n'
        f'<rect width="{width}" height="{height}" fill="{drawing.background}"/>\n{body}\n</svg>\n'
    )


def _element(shape: Shape) -> str:
    if isinstance(shape, Words):
        return _words(shape)
    if isinstance(shape, Inset):
        return _inset(shape)
    faint = f' opacity="{shape.opacity:.3g}"' if shape.opacity < 1 else ""
    if isinstance(shape, Patch):
        fill = _hex(as_colors(shape.color, "color", 1)[0])
        return f'<polygon points="{_pairs(shape.points)}" fill="{fill}"{faint}/>'
    if len(shape.points) == 1:
        (x, y), fill = shape.points[0], _hex(shape.colors[0])
        return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{shape.width / 2:.2f}" fill="{fill}"{faint}/>'
    return _line(shape, faint)


def _line(shape: Stroke, faint: str) -> str:
    dash = f' stroke-dasharray="{" ".join(f"{d:g}" for d in shape.dash)}"' if shape.dash else ""
    style = f'fill="none" stroke-width="{shape.width:g}" stroke-linejoin="round"{dash}{faint}'
    if isinstance(shape.color, str):
        ends = 'stroke-linecap="round"'
        return f'<polyline points="{_pairs(shape.points)}" stroke="{shape.color}" {ends} {style}/>'
    middle = 0.5 * (shape.colors[1:] + shape.colors[:-1])
    parts = [
        f'<polyline points="{_pairs(shape.points[i : i + 2])}" stroke="{_hex(c)}" stroke-linecap="round"/>'
        for i, c in enumerate(middle)
    ]
    return f"<g {style}>{''.join(parts)}</g>"


def _words(words: Words) -> str:
    rim = f' paint-order="stroke" stroke="{words.halo}" stroke-width="3"' if words.halo else ""
    return (
        f'<text x="{words.at[0]:.1f}" y="{words.at[1] + 0.36 * words.size:.1f}" font-size="{words.size:g}" '
        f'fill="{words.color}" text-anchor="{words.anchor}"{rim}>{escape(words.text)}</text>'
    )


def _inset(inset: Inset) -> str:
    buffer = BytesIO()
    pillow().Image.fromarray(np.ascontiguousarray(inset.picture)).save(buffer, "PNG", optimize=True)
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    (x, y), (width, height) = inset.at, inset.size
    return (
        f'<image x="{x - width / 2:.1f}" y="{y - height / 2:.1f}" width="{width:g}" height="{height:g}" '
        f'href="data:image/png;base64,{data}"/>'
    )


def _pairs(points: FloatArray) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in np.asarray(points))


def _hex(color: Any) -> str:
    return "#" + "".join(f"{round(255 * float(c)):02x}" for c in np.clip(color, 0, 1))
