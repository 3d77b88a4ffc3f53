"""The colours of a picture, dark or light: the tokens the studio uses too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray


def rgb(code: str) -> FloatArray:
    """Read a colour written as ``#rrggbb``.

    Parameters
    ----------
    code : str
        Six hexadecimal digits after ``#``.

    Returns
    -------
    (3,) ndarray of float64
        sRGB, 0 to 1.

    Raises
    ------
    ValueError
        If the text is no such code.

    Examples
    --------
    >>> rgb("#ff0033")
    array([1. , 0. , 0.2])
    """
    digits = code.removeprefix("#")
    try:
        if len(digits) != 6:
            raise ValueError
        return np.frombuffer(bytes.fromhex(digits), dtype=np.uint8) / 255.0
    except ValueError:
        raise ValueError(f"a colour must be written as '#rrggbb', got {code!r}") from None


@dataclass(frozen=True)
class Theme:
    """Colours as ``#rrggbb``."""

    name: str
    """``"dark"`` or ``"light"``."""
    view: str
    """Background of a view."""
    floor: str
    """Ground under the model, where nothing shades it."""
    panel: str
    """Background of a sheet around its views."""
    line: str
    """Faint lines: the fine grid, borders."""
    strong_line: str
    """Metre lines of the grid."""
    text: str
    """Titles."""
    text_2: str
    """Captions."""
    text_3: str
    """Notes."""
    mesh: str
    """Surface without colours of its own."""
    back: str
    """Back faces: an inside-out or torn place."""
    wire: str
    """Edges drawn over the surface."""
    held: str
    """What the user holds; default colour of points and segments."""
    accent: str
    """First colour of charts."""
    left: str
    """Bones and marks of the left side."""
    right: str
    """Bones and marks of the right side."""
    centre: str
    """Bones and marks on neither side."""
    error: str
    """Failures."""
    shadow: float
    """How dark the deepest shadow on the ground is, 0 none, 1 black."""


DARK = Theme(
    name="dark",
    view="#121418",
    floor="#272b32",
    panel="#15171b",
    line="#2b3038",
    strong_line="#4a515d",
    text="#e8eaed",
    text_2="#b1b7c1",
    text_3="#8b929e",
    mesh="#a4a8b0",
    back="#ff5a4f",
    wire="#15171b",
    held="#ff9f45",
    accent="#8b9aff",
    left="#52c3ea",
    right="#f47d95",
    centre="#dcc56a",
    error="#ff7b72",
    shadow=0.92,
)

LIGHT = Theme(
    name="light",
    view="#eef0f3",
    floor="#eef0f3",
    panel="#f6f7f9",
    line="#dfe2e8",
    strong_line="#b4bac5",
    text="#16181d",
    text_2="#434a56",
    text_3="#5d6573",
    mesh="#b6b9bf",
    back="#d8392c",
    wire="#30353d",
    held="#e0700a",
    accent="#4650c8",
    left="#0a6f94",
    right="#b92f52",
    centre="#7a6300",
    error="#c0291f",
    shadow=0.62,
)


def theme_named(theme: str | Theme) -> Theme:
    """Find a theme by name.

    Parameters
    ----------
    theme : str or Theme
        ``"dark"``, ``"light"`` or a theme of one's own.

    Returns
    -------
    Theme
        The colours.

    Raises
    ------
    ValueError
        If there is no theme of that name.
    """
    if isinstance(theme, Theme):
        return theme
    for known in (LIGHT, DARK):
        if known.name == theme:
            return known
    raise ValueError(f"theme must be 'light' or 'dark', got {theme!r}")
