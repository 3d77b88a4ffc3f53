"""The error of every frame as a chart, one curve a way to make the frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tempose.render import Theme
from tempose.render.chart_scale import value_range
from tempose.render.drawing import Drawing, Words
from tempose.render.graph import Graph, legend
from tempose.render.themes import theme_named
from tempose.typing import FloatArray

_SIZE = (760, 330)
_BOX = (56.0, 84.0, 738.0, 284.0)
_DASHES: tuple[tuple[float, ...], ...] = ((), (7, 4), (2, 4), (9, 3, 2, 3))


def draw_frame_errors(
    errors: Mapping[str, FloatArray],
    title: str = "rms error, % of the diagonal",
    *,
    parts: Sequence[int] = (),
    theme: str | Theme = "light",
) -> Drawing:
    """Draw the error of every frame.

    Parameters
    ----------
    errors : mapping of str to (T,) float
        Name to error, the most important last, at most four. NaN leaves a gap.
    title : str
        What is up the axis, and its unit.
    parts : sequence of int, optional
        Frames at which one part ends and another begins; every second part is shaded.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        For `tempose.render.drawing.save_drawing`.
    """
    tone = theme_named(theme)
    curves = {name: np.asarray(y, dtype=np.float64) for name, y in errors.items()}
    count = max((len(y) for y in curves.values()), default=1)
    top = value_range([*curves.values(), np.zeros(1)], None)[1]
    last = float(max(count - 1, 1))
    graph = Graph(Drawing(*_SIZE, tone.panel), tone, _BOX, (0.0, last), (0.0, max(top, 1e-12)))
    for x0, x1 in list(zip([0, *parts], [*parts, count]))[1::2]:
        graph.band(max(x0 - 0.5, 0.0), min(x1 - 0.5, last), tone.text_3, 0.08)
    graph.axes("", "frame", whole=True)
    graph.drawing.add(Words(title, (_BOX[0] - 34, 26), 12.5, tone.text))
    inks = dict(zip(reversed(curves), (tone.accent, tone.right, tone.left, tone.text_3)))
    dashes = dict(zip(reversed(curves), _DASHES))
    for name, y in curves.items():
        graph.line(np.arange(len(y)), y, inks[name], dash=dashes[name])
    entries = [(name, inks[name], dashes[name]) for name in curves]
    legend(graph.drawing, _BOX[2], _BOX[1] - 20, entries, tone.text_2)
    return graph.drawing
