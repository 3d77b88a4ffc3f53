"""Charts of a fit: the error of every frame, what the shape signal leaves out, the clock of the edits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tempose.render import Theme
from tempose.render.chart_scale import value_range
from tempose.render.drawing import Drawing, Words
from tempose.render.graph import Graph, legend
from tempose.render.themes import theme_named
from tempose.signals.pictures.pose_plane import time_colors
from tempose.signals.pictures.region import WARNING
from tempose.signals.signals import Signals
from tempose.typing import FloatArray

_SIZE = (760, 300)
_BOX = (56.0, 54.0, 738.0, 254.0)
_DASHES: tuple[tuple[float, ...], ...] = ((), (7, 4), (2, 4), (9, 3, 2, 3))


def draw_errors(
    errors: Mapping[str, FloatArray], tolerance: float | None = None, theme: str | Theme = "light"
) -> Drawing:
    """Draw the error of every frame.

    Parameters
    ----------
    errors : mapping of str to (T,) float
        Name to error in percent of the diagonal, the most important last.
    tolerance : float, optional
        What was asked for, in the same unit.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        For `tempose.render.save_drawing`.
    """
    tone = theme_named(theme)
    curves = {name: np.asarray(y, dtype=np.float64) for name, y in errors.items()}
    limit = np.array([] if tolerance is None else [tolerance])
    count = max((len(y) for y in curves.values()), default=1)
    top = value_range([*curves.values(), limit], None)[1]
    graph = _graph(tone, (0.0, float(max(count - 1, 1))), (0.0, max(top, 1e-12)))
    graph.axes("rms error, % of the diagonal", "frame", whole=True)
    if tolerance is not None:
        graph.level(tolerance, f"tolerance {tolerance:g}", WARNING[tone.name])
    inks = dict(zip(reversed(curves), (tone.accent, tone.right, tone.left, tone.text_3)))
    dashes = dict(zip(reversed(curves), _DASHES))
    for name, y in curves.items():
        graph.line(np.arange(len(y)), y, inks[name], dash=dashes[name])
        if len(y) <= 60:
            for at in graph.place(np.arange(len(y)), y):
                graph.drawing.disc(at, 2.4, inks[name])
    entries = [(name, inks[name], dashes[name]) for name in curves]
    legend(graph.drawing, _BOX[2], _BOX[1] - 20, entries, tone.text_2)
    return graph.drawing


def draw_scree(
    left_out: FloatArray, m: int, tolerance: float | None = None, theme: str | Theme = "light"
) -> Drawing:
    """Draw what the shape signal leaves out for every number of components.

    Parameters
    ----------
    left_out : (r,) float
        Error of the shape signal with 0, 1, 2... components, percent of the diagonal.
    m : int
        The number that the model has.
    tolerance : float, optional
        What was asked for, in the same unit.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        For `tempose.render.save_drawing`.
    """
    tone = theme_named(theme)
    y = np.asarray(left_out, dtype=np.float64)
    high = float(max(y.max(initial=0.0), 1e-9))
    # rounding is not worth half of the picture: six decades are shown
    shown = np.flatnonzero(y > 1e-6 * high)
    count = max(int(shown[-1]) + 1 if len(shown) else 1, m + 1, 2)
    low = float(max(y[:count][y[:count] > 0].min(initial=high), 1e-6 * high))
    graph = _graph(tone, (0.0, float(count - 1)), (0.7 * low, 1.4 * high), log=True)
    graph.axes("left out by the shape signal, rms, % of the diagonal", "components m", whole=True)
    if tolerance is not None and graph.y_range[0] < tolerance < graph.y_range[1]:
        graph.level(tolerance, f"tolerance {tolerance:g}", WARNING[tone.name])
    at = np.arange(min(count, len(y)))
    graph.line(at, np.maximum(y[: len(at)], low), tone.accent)
    for i, place in zip(at, graph.place(at, np.maximum(y[: len(at)], low))):
        if len(at) <= 120 or i == m:
            graph.drawing.disc(place, 5.0 if i == m else 2.4, tone.accent)
        if i == m:
            graph.drawing.disc(place, 3.2, tone.panel)
            words = Words(
                f"m = {m}", (float(place[0]) + 9, float(place[1]) - 11), 12, tone.accent, halo=tone.panel
            )
            graph.drawing.add(words)
    return graph.drawing


def draw_retiming(signals: Signals, theme: str | Theme = "light") -> Drawing:
    """Draw where in the curve the frames that are played read.

    Parameters
    ----------
    signals : Signals
        A clip.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        Seconds played to the right, frames of the curve upwards; a dashed line is normal speed.
    """
    tone = theme_named(theme)
    seconds = np.linspace(0.0, max(signals.duration, 1e-9), 600)
    ticks = signals.ticks(seconds)
    top = float(signals.time.pace.domain[1])
    graph = _graph(tone, (0.0, float(seconds[-1])), (0.0, max(top, 1e-9)))
    graph.axes("where the curve is read, frames of the clip", "seconds played")
    normal = ticks[0] + seconds * signals.rate
    inside = normal <= top
    graph.line(seconds[inside], normal[inside], tone.text_3, width=1.2, dash=(4, 5))
    graph.line(seconds, ticks, tone.accent, width=2.2)
    if signals.n_frames <= 240:
        places = graph.place(signals.times, signals.ticks(signals.times))
        for at, color in zip(places, time_colors(signals.times, signals.duration, tone)):
            graph.drawing.disc(at, 2.8, color)
    entries = [("normal speed", tone.text_3, (4.0, 5.0)), ("played", tone.accent, ())]
    legend(graph.drawing, _BOX[2], _BOX[1] - 20, entries, tone.text_2)
    return graph.drawing


def _graph(tone: Theme, xs: tuple[float, float], ys: tuple[float, float], log: bool = False) -> Graph:
    return Graph(Drawing(*_SIZE, tone.panel), tone, _BOX, xs, ys, log)
