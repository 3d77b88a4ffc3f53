"""The latent space as a picture: the path of the frames over how sure the learner is."""

from __future__ import annotations

import numpy as np

from tempose.detail.pictures.plane import LatentPlane
from tempose.render import Theme, ramp_colors
from tempose.render.colors import Picture
from tempose.render.drawing import Drawing, Inset, Stroke, Words
from tempose.render.graph import Graph
from tempose.render.themes import theme_named
from tempose.typing import FloatArray

_LONGEST = 640.0
_MARGINS = (24.0, 56.0, 24.0, 62.0)
_FINE = 6
"""Pixels of the map for each of its places."""


def draw_latent(plane: LatentPlane, *, unit: str = "mm", theme: str | Theme = "light") -> Drawing:
    """Draw the frames of a training over the spread of predictions (Fig. 4 of the paper in one picture).

    Parameters
    ----------
    plane : LatentPlane
        Frames and map.
    unit : str, default "mm"
        ``"mm"`` or ``"m"``, in which the spread is written.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        For `tempose.render.drawing.save_drawing`.
    """
    tone = theme_named(theme)
    left, top, right, bottom = _MARGINS
    wide, high = float(np.ptp(plane.x)), float(np.ptp(plane.y))
    scale = _LONGEST / max(wide, high)
    width, height = max(scale * wide, 420.0), scale * high
    drawing = Drawing(round(left + width + right), round(top + height + bottom), tone.panel)
    box = (left, top, left + width, top + height)
    xs, ys = (float(plane.x[0]), float(plane.x[-1])), (float(plane.y[0]), float(plane.y[-1]))
    graph = Graph(drawing, tone, box, xs, ys)
    low, up = float(plane.spread.min()), float(plane.spread.max())
    up = up if up > low else low + max(low, 1e-9)
    drawing.add(Inset(_map(plane.spread, low, up), (left + width / 2, top + height / 2), (width, height)))
    _path(graph, plane, tone)
    what = "latent space" if plane.latent else "angles and velocities"
    title = f"{what}, two directions with {100 * plane.share:.0f} % of the variance"
    drawing.add(Words(title, (left, top - 30), 12.5, tone.text))
    clips = len(np.unique(plane.chains))
    drawing.add(
        Words(
            f"{len(plane.points)} frames of {clips} clip{'s' * (clips > 1)}",
            (left, top - 13),
            11,
            tone.text_2,
        )
    )
    _legend(graph, low, up, unit)
    return drawing


def _map(spread: FloatArray, low: float, high: float) -> Picture:
    fine = _smooth(spread)[::-1]
    picture = np.full((*fine.shape, 4), 255, dtype=np.uint8)
    picture[..., :3] = np.round(255 * ramp_colors(fine, low, high, "heat"))
    return picture


def _smooth(A: FloatArray) -> FloatArray:
    """Interpolate linearly between places, along one axis after the other."""
    for _ in range(2):
        n = len(A)
        at = np.linspace(0, n - 1, _FINE * n)
        i = np.minimum(at.astype(int), max(n - 2, 0))
        t = (at - i)[:, None]
        A = ((1 - t) * A[i] + t * A[np.minimum(i + 1, n - 1)]).T
    return A


def _path(graph: Graph, plane: LatentPlane, tone: Theme) -> None:
    spots = graph.place(plane.points[:, 0], plane.points[:, 1])
    ramp = "time-dark" if tone.name == "dark" else "time"
    for chain in np.unique(plane.chains):
        frames = np.flatnonzero(plane.chains == chain)
        colors = ramp_colors(np.linspace(0, 1, len(frames)), 0.0, 1.0, ramp)
        if len(frames) > 1:
            graph.drawing.add(Stroke(spots[frames], "#ffffff", 4.0, opacity=0.6))
            graph.drawing.add(Stroke(spots[frames], colors, 1.8))
        for at, color in zip(spots[frames], colors):
            graph.drawing.disc(at, 2.6, color)


def _legend(graph: Graph, low: float, high: float, unit: str) -> None:
    left, bottom = graph.box[0], graph.box[3]
    tone, factor = graph.tone, 1000.0 if unit == "mm" else 1.0
    y, begin, end = bottom + 22, left + 58, left + 58 + 170
    stops = np.column_stack([np.linspace(begin, end, 48), np.full(48, y)])
    graph.drawing.add(Stroke(stops, ramp_colors(np.linspace(0, 1, 48), 0.0, 1.0, "heat"), 9.0))
    graph.drawing.add(Words(f"{factor * low:.3g} {unit}", (begin - 10, y), 11, tone.text_2, "end"))
    words = f"{factor * high:.3g} {unit}: error expected of a coordinate"
    graph.drawing.add(Words(words, (end + 10, y), 11, tone.text_2))
    note = "blue: the first frames, yellow: the last"
    graph.drawing.add(Words(note, (left, y + 22), 11, tone.text_3))
