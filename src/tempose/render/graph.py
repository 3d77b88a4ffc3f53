"""Axes in a drawing: curves, levels and marks over two scales."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.render.chart_scale import nice_ticks
from tempose.render.drawing import Drawing, Patch, Stroke, Words
from tempose.render.themes import Theme
from tempose.typing import FloatArray


@dataclass(eq=False)
class Graph:
    """A rectangle of a drawing in which numbers have places."""

    drawing: Drawing
    """What is drawn into."""
    tone: Theme
    """Colours."""
    box: tuple[float, float, float, float]
    """Left, top, right, bottom, pixels."""
    x_range: tuple[float, float]
    """Numbers at the left and at the right."""
    y_range: tuple[float, float]
    """Numbers at the bottom and at the top; positive if `log`."""
    log: bool = False
    """Whether the vertical scale is one of powers of ten."""

    def place(self, x: Any, y: Any) -> FloatArray:
        """Return where numbers lie in the drawing.

        Parameters
        ----------
        x, y : (...) float
            Numbers.

        Returns
        -------
        (..., 2) ndarray
            Pixels.
        """
        left, top, right, bottom = self.box
        (x0, x1), (y0, y1) = self.x_range, self._scaled(np.asarray(self.y_range))
        u = (np.asarray(x, dtype=np.float64) - x0) / (x1 - x0)
        v = (self._scaled(np.asarray(y, dtype=np.float64)) - y0) / (y1 - y0)
        return np.stack(np.broadcast_arrays(left + u * (right - left), bottom - v * (bottom - top)), axis=-1)

    def _scaled(self, y: FloatArray) -> FloatArray:
        return np.log10(np.maximum(y, 1e-300)) if self.log else y

    def axes(self, title: str, x_label: str, *, whole: bool = False) -> None:
        """Draw the scales.

        Parameters
        ----------
        title : str
            What stands over the graph: what is up the vertical axis, and its unit.
        x_label : str
            What goes to the right.
        whole : bool, default False
            Whether only whole numbers stand under the graph.
        """
        left, top, right, bottom = self.box
        ink: dict[str, Any] = {"size": 11.0, "color": self.tone.text_3}
        for v in self._y_ticks():
            y = float(self.place(self.x_range[0], v)[1])
            self.drawing.add(Stroke(np.array([[left, y], [right, y]]), self.tone.line, 1.0))
            self.drawing.add(Words(f"{v:.6g}", (left - 8, y), anchor="end", **ink))
        for v in nice_ticks(*self.x_range, max(int((right - left) / 70), 2)):
            if whole and v != round(v):
                continue
            x = float(self.place(v, self.y_range[0])[0])
            self.drawing.add(Stroke(np.array([[x, bottom], [x, bottom + 4]]), self.tone.strong_line, 1.0))
            self.drawing.add(Words(f"{v:.6g}", (x, bottom + 13), anchor="middle", **ink))
        self.drawing.add(Stroke(np.array([[left, bottom], [right, bottom]]), self.tone.strong_line, 1.0))
        self.drawing.add(Words(title, (left - 34, top - 20), 12.5, self.tone.text))
        self.drawing.add(Words(x_label, (right, bottom + 30), anchor="end", **ink))

    def _y_ticks(self) -> list[float]:
        if not self.log:
            return nice_ticks(*self.y_range, max(int((self.box[3] - self.box[1]) / 44), 2))
        low, high = np.log10(self.y_range)
        steps = (1,) if high - low > 3 else (1, 2, 5)
        ticks = [m * 10.0**k for k in range(int(np.floor(low)), int(np.ceil(high)) + 1) for m in steps]
        return [v for v in ticks if self.y_range[0] * 0.999 <= v <= self.y_range[1] * 1.001]

    def line(self, x: Any, y: Any, color: str, *, width: float = 1.8, dash: Sequence[float] = ()) -> None:
        """Draw a curve; where values are missing it breaks.

        Parameters
        ----------
        x, y : (n,) float
            Numbers; y may be NaN, and is kept inside the graph.
        color : str
            ``"#rrggbb"``.
        width : float, default 1.8
            Pixels.
        dash : sequence of float, optional
            As for `Stroke`.
        """
        points: Any = self.place(x, np.clip(y, *self.y_range))
        there = np.asarray(np.isfinite(points).all(axis=1))
        for part in np.split(np.arange(len(points)), np.flatnonzero(np.diff(there.astype(int))) + 1):
            if len(part) and there[part[0]]:
                self.drawing.add(Stroke(points[part], color, width, dash))

    def level(self, value: float, name: str, color: str) -> None:
        """Draw a level and its name.

        Parameters
        ----------
        value : float
            Where.
        name : str
            What it is; at the right, above the line.
        color : str
            ``"#rrggbb"``.
        """
        ends = self.place(np.asarray(self.x_range), value)
        self.drawing.add(Stroke(ends, color, 1.0, (2, 4)))
        at = (self.box[2], float(ends[1, 1]) - 8)
        self.drawing.add(Words(name, at, 11, color, "end", self.drawing.background))

    def band(self, x0: float, x1: float, color: str, opacity: float = 0.14) -> None:
        """Shade what lies between two numbers.

        Parameters
        ----------
        x0, x1 : float
            From, to.
        color : str
            ``"#rrggbb"``.
        opacity : float, default 0.14
            0 to 1.
        """
        (a, low), (b, high) = self.place(x0, self.y_range[0]), self.place(x1, self.y_range[1])
        self.drawing.add(Patch(np.array([[a, low], [b, low], [b, high], [a, high]]), color, opacity))


def legend(
    drawing: Drawing,
    right: float,
    y: float,
    entries: Sequence[tuple[str, str, Sequence[float]]],
    text_color: str,
) -> None:
    """Name curves, in one line.

    Parameters
    ----------
    drawing : Drawing
        What is drawn into.
    right, y : float
        Where the line ends, pixels.
    entries : sequence of (name, color, dash)
        From left to right.
    text_color : str
        ``"#rrggbb"``.
    """
    for name, color, dash in reversed(entries):
        drawing.add(Words(name, (right, y), 11, text_color, "end"))
        right -= text_width(name, 11) + 7
        drawing.add(Stroke(np.array([[right - 20, y], [right, y]]), color, 1.8, dash))
        right -= 38


def text_width(text: str, size: float) -> float:
    """Return about how wide a line of text is, without a font.

    Parameters
    ----------
    text : str
        One line.
    size : float
        Font size, pixels.

    Returns
    -------
    float
        Pixels.
    """
    narrow = sum(c in " .,:;'|!ijlt()[]" for c in text)
    return size * (0.56 * (len(text) - narrow) + 0.3 * narrow)
