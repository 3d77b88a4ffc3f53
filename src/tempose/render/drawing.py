"""Drawings of lines, marks, words and pictures, made once and written as PNG or SVG."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from tempose._files import atomic_path
from tempose.render.colors import as_colors
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line through points, with round ends; one point makes a dot."""

    points: FloatArray
    """(n, 2) pixels, x to the right, y down."""
    color: Any = "#000000"
    """``"#rrggbb"``, or (n, 3) sRGB from 0 to 1, a colour a point."""
    width: float = 1.5
    """Pixels."""
    dash: Sequence[float] = ()
    """Pixels drawn and left out, in turns; none: all is drawn."""
    opacity: float = 1.0
    """0 to 1."""

    @property
    def colors(self) -> FloatArray:
        """(n, 3) sRGB from 0 to 1."""
        return as_colors(self.color, "color", len(self.points))


@dataclass(frozen=True, eq=False)
class Patch:
    """A filled convex polygon."""

    points: FloatArray
    """(n, 2) pixels."""
    color: Any = "#000000"
    """``"#rrggbb"`` or (3,) sRGB from 0 to 1."""
    opacity: float = 1.0
    """0 to 1."""


@dataclass(frozen=True, eq=False)
class Words:
    """A line of text."""

    text: str
    """What it says."""
    at: tuple[float, float]
    """Pixels: where the anchor is, half way between the feet and the tops of capitals."""
    size: float = 12.0
    """Pixels."""
    color: str = "#000000"
    """``"#rrggbb"``."""
    anchor: str = "start"
    """``"start"``, ``"middle"`` or ``"end"``."""
    halo: str = ""
    """``"#rrggbb"`` of a rim that keeps it readable over lines; empty for none."""


@dataclass(frozen=True, eq=False)
class Inset:
    """A picture inside the drawing."""

    picture: Any
    """(height, width, 4) uint8: sRGB and opacity."""
    at: tuple[float, float]
    """Pixels: its middle."""
    size: tuple[float, float]
    """Pixels: width and height."""


Shape: TypeAlias = Stroke | Patch | Words | Inset
"""What a drawing is made of."""


@dataclass(eq=False)
class Drawing:
    """Shapes over a background, later ones over earlier ones."""

    width: int
    """Pixels."""
    height: int
    """Pixels."""
    background: str = "#ffffff"
    """``"#rrggbb"``."""
    shapes: list[Shape] = field(default_factory=list["Shape"])
    """In the order in which they are drawn."""

    def add(self, *shapes: Shape) -> None:
        """Put shapes over what is there.

        Parameters
        ----------
        *shapes : Stroke, Patch, Words or Inset
            In order.
        """
        self.shapes.extend(shapes)

    def disc(self, at: Sequence[float], radius: float, color: Any) -> None:
        """Put a filled circle over what is there.

        Parameters
        ----------
        at : (float, float)
            Its middle, pixels.
        radius : float
            Pixels.
        color : str or (3,) float
            As for `Patch`.
        """
        self.add(Stroke(np.array([at], dtype=float), as_colors(color, "color", 1), 2 * radius))

    def box(self, at: Sequence[float], half: float, edge: Any, fill: Any, width: float = 1.3) -> None:
        """Put a square with an outline over what is there.

        Parameters
        ----------
        at : (float, float)
            Its middle, pixels.
        half : float
            Half a side, pixels.
        edge, fill : str or (3,) float
            Colours, as for `Patch`.
        width : float, default 1.3
            Width of the outline, pixels.
        """
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)
        self.add(Patch(np.asarray(at) + corners * (half + width / 2), edge))
        self.add(Patch(np.asarray(at) + corners * (half - width / 2), fill))


def save_drawing(drawing: Drawing, path: str | os.PathLike[str], scale: float = 2.0) -> None:
    """Write a drawing as ``.png`` or ``.svg``.

    Parameters
    ----------
    drawing : Drawing
        What to write.
    path : path-like
        File to write or replace; its ending says which.
    scale : float, default 2
        Pixels of a PNG for each pixel of the drawing.

    Raises
    ------
    ValueError
        If the ending is another.
    """
    from tempose.render.drawing_raster import drawing_picture
    from tempose.render.drawing_svg import drawing_svg
    from tempose.render.writers import save_png

    suffix = Path(path).suffix.lower()
    if suffix == ".png":
        save_png(drawing_picture(drawing, scale), path)
    elif suffix == ".svg":
        with atomic_path(path) as part:
            part.write_text(drawing_svg(drawing), encoding="utf-8")
    else:
        raise ValueError(f"{path}: a drawing is written as .png or .svg, got {suffix!r}")
