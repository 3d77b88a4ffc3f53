"""Pictures with captions laid out in rows, under a title and beside a legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.render.colors import Picture, ramp_colors
from tempose.render.text import draw_text, text_size
from tempose.render.themes import Theme, rgb

PAD, GAP, CAPTION, TITLE, BAR = 10, 4, 13, 17, 140


@dataclass(frozen=True, eq=False)
class Row:
    """Pictures of one size, side by side."""

    pictures: Sequence[Picture]
    """(height, width, 3) uint8 each."""
    captions: Sequence[str]
    """A line under each; may be empty."""
    label: str = ""
    """Written into the first picture."""


@dataclass(frozen=True)
class Legend:
    """What colours mean."""

    low: float
    """Number of the first colour."""
    high: float
    """Number of the last colour."""
    label: str
    """Name and unit."""
    ramp: str
    """Name out of `tempose.render.RAMPS`."""


def lay_out(rows: Sequence[Row], title: str, tone: Theme, legend: Legend | None = None) -> Picture:
    """Put rows of pictures on a sheet.

    Parameters
    ----------
    rows : sequence of Row
        At least one row with at least one picture.
    title : str
        Line above; may be empty.
    tone : Theme
        Colours.
    legend : Legend, optional
        Drawn at the upper right.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.

    Raises
    ------
    ValueError
        If there is no picture.
    """
    if not any(len(row.pictures) for row in rows):
        raise ValueError("a sheet needs at least one picture, got none")
    strips = [CAPTION + 10 if any(row.captions) else GAP for row in rows]
    heights = [max(p.shape[0] for p in row.pictures) + strip for row, strip in zip(rows, strips)]
    widths = [sum(p.shape[1] + GAP for p in row.pictures) - GAP for row in rows]
    top = PAD + (TITLE + 10 if title or legend else 0)
    sheet = np.zeros((top + sum(heights) + PAD - min(strips[-1], GAP), max(widths) + 2 * PAD, 3), np.uint8)
    sheet[:] = _bytes(rgb(tone.panel))
    if title:
        draw_text(sheet, title, (PAD, PAD - 1), TITLE, rgb(tone.text))
    if legend is not None:
        _draw_legend(sheet, legend, tone)
    y = top
    for row, height, strip in zip(rows, heights, strips):
        _draw_row(sheet, row, y, y + height - strip + 4, tone)
        y += height
    return sheet


def _draw_row(sheet: Picture, row: Row, y: int, caption_y: int, tone: Theme) -> None:
    x = PAD
    for picture, caption in zip(row.pictures, row.captions):
        height, width = picture.shape[:2]
        sheet[y : y + height, x : x + width] = picture
        if caption:
            draw_text(sheet, caption, (x + 2, caption_y), CAPTION, rgb(tone.text_2))
        x += width + GAP
    if row.label:
        draw_text(sheet, row.label, (PAD + 8, y + 6), CAPTION, rgb(tone.text_3))


def _draw_legend(sheet: Picture, legend: Legend, tone: Theme) -> None:
    right, y = sheet.shape[1] - PAD, PAD + 9
    high = f"{legend.high:.3g}"
    x1 = right - text_size(high, CAPTION)[0] - 6
    x0 = max(x1 - BAR, PAD)
    sheet[y - 5 : y + 5, x0:x1] = _bytes(ramp_colors(np.linspace(0, 1, x1 - x0), 0, 1, legend.ramp))[None]
    draw_text(sheet, high, (right, y), CAPTION, rgb(tone.text_2), anchor="rm")
    words = f"{legend.label}   {legend.low:.3g}".strip()
    draw_text(sheet, words, (x0 - 6, y), CAPTION, rgb(tone.text_2), anchor="rm")


def _bytes(color: Any) -> Picture:
    return np.round(np.asarray(color) * 255).astype(np.uint8)
