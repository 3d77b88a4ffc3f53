"""The pose plane as a picture: the curve, its controls, the frames, the sites, and some of the meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from tempose.render import Theme, ramp_colors
from tempose.render.chart_scale import nice_ticks
from tempose.render.drawing import Drawing, Inset, Stroke, Words
from tempose.render.graph import Graph, text_width
from tempose.render.themes import theme_named
from tempose.signals.pictures.clipping import clipped
from tempose.signals.pictures.crowding import Crowd
from tempose.signals.pictures.region import WARNING, curve_points, plane_graph, used_region
from tempose.signals.pictures.thumbnails import make_studio
from tempose.signals.signals import Signals
from tempose.typing import FloatArray

THUMBNAIL = (96, 74)
"""Width and height of a small picture, pixels."""


def draw_pose_plane(
    signals: Signals,
    *,
    bad: Sequence[int] = (),
    thumbnails: int = 10,
    title: str = "",
    theme: str | Theme = "light",
) -> Drawing:
    """Draw the pose plane of a clip.

    Parameters
    ----------
    signals : Signals
        A clip.
    bad : sequence of int, optional
        Bad transitions, each by the frame before it; they get a dashed ring.
    thumbnails : int, default 10
        How many meshes are shown beside their frames, where there is room.
    title : str
        A line above.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    Drawing
        For `tempose.render.save_drawing`.
    """
    tone = theme_named(theme)
    graph = plane_graph(used_region(signals, controls=True), tone)
    draw_plane_axes(graph, title)
    seconds, curve = curve_points(signals)
    line = graph.place(curve[:, 0], curve[:, 1])
    frames = graph.place(*signals.time(signals.ticks(signals.times)).T)
    left, top, right, bottom = graph.box
    controls = _polygon(graph, signals)
    sites = graph.place(*signals.pose.sites.T)
    crowd = Crowd(
        np.concatenate([line, controls, controls, sites, sites]), (left + 4, top + 4, right - 4, bottom - 4)
    )
    if thumbnails:
        _thumbnails(graph, signals, frames, crowd, thumbnails)
    _before_edits(graph, signals, seconds, curve)
    graph.drawing.add(Stroke(line, time_colors(seconds, signals.duration, tone), 3.2))
    _frames(graph, signals, frames)
    _controls(graph, np.array(list(_inside(graph, controls).values())))
    _bad(graph, signals, bad, crowd)
    _frame_numbers(graph, signals, frames, crowd)
    _control_numbers(graph, controls, crowd)
    _legend(graph, signals, bool(len(bad)))
    return graph.drawing


def time_colors(seconds: FloatArray, duration: float, tone: Theme) -> FloatArray:
    """Return the colours of times.

    Parameters
    ----------
    seconds : (s,) float
        Times.
    duration : float
        Seconds of the whole clip.
    tone : Theme
        Light or dark.

    Returns
    -------
    (s, 3) ndarray
        sRGB, 0 to 1.
    """
    ramp = "time-dark" if tone.name == "dark" else "time"
    return ramp_colors(seconds, 0.0, max(duration, 1e-9), ramp)


def draw_plane_axes(graph: Graph, title: str = "") -> None:
    """Draw the scales of a picture of the pose plane, which edits and pins are written in.

    Parameters
    ----------
    graph : Graph
        Of the plane.
    title : str
        A line above.
    """
    tone, (left, top, right, bottom) = graph.tone, graph.box
    ink: dict[str, Any] = {"size": 11.0, "color": tone.text_3}
    for v in nice_ticks(*graph.x_range, 6):
        x = float(graph.place(v, graph.y_range[0])[0])
        graph.drawing.add(Stroke(np.array([[x, top], [x, bottom]]), tone.line, 1.0))
        graph.drawing.add(Words(f"{v:.6g}", (x, bottom + 13), anchor="middle", **ink))
    for v in nice_ticks(*graph.y_range, 6):
        y = float(graph.place(graph.x_range[0], v)[1])
        graph.drawing.add(Stroke(np.array([[left, y], [right, y]]), tone.line, 1.0))
        graph.drawing.add(Words(f"{v:.6g}", (left - 8, y), anchor="end", **ink))
    if title:
        graph.drawing.add(Words(title, (left, top - 12), 12.5, tone.text))


def _thumbnails(graph: Graph, signals: Signals, frames: FloatArray, crowd: Crowd, count: int) -> None:
    chosen = np.unique(np.linspace(0, len(frames) - 1, min(count, len(frames))).round().astype(int))
    V = signals.shape.vertices(signals.coordinates(signals.times[chosen]))
    studio = make_studio(V, graph.tone, THUMBNAIL)
    half = (THUMBNAIL[0] / 2, THUMBNAIL[1] / 2)
    for i, v in zip(chosen, V):
        at = crowd.settle(frames[i], half, (16.0, 30.0, 50.0, 80.0))
        if at is None:
            continue
        color = time_colors(signals.times[i : i + 1], signals.duration, graph.tone)
        graph.drawing.add(Stroke(np.stack([frames[i], at]), np.repeat(color, 2, axis=0), 1.0, opacity=0.45))
        graph.drawing.add(
            Inset(studio.picture(v, signals.mesh.faces), (float(at[0]), float(at[1])), THUMBNAIL)
        )


def _polygon(graph: Graph, signals: Signals) -> FloatArray:
    controls = graph.place(*signals.time.curve.controls.T)
    for part in clipped(controls, graph.box):
        graph.drawing.add(Stroke(part, graph.tone.strong_line, 1.0))
    return controls


def _before_edits(graph: Graph, signals: Signals, seconds: FloatArray, curve: FloatArray) -> None:
    before = signals.time.before_edits(signals.ticks(seconds))
    if (before != curve).any():
        moved = np.linalg.norm(before - curve, axis=1) > 1e-9 * np.ptp(graph.x_range)
        for part in np.split(np.arange(len(moved)), np.flatnonzero(np.diff(moved.astype(int))) + 1):
            if moved[part[0]] and len(part) > 1:
                points = graph.place(*before[part].T)
                graph.drawing.add(Stroke(points, graph.tone.text_3, 1.4, (4, 5)))


def _frames(graph: Graph, signals: Signals, frames: FloatArray) -> None:
    tone, drawing = graph.tone, graph.drawing
    sites = graph.place(*signals.pose.sites.T)
    radius = 3.6 if len(frames) <= 120 else 2.2
    colors = time_colors(signals.times, signals.duration, tone)
    nearest: Any = KDTree(frames).query(sites)
    for site, gap, i in zip(sites, *nearest):
        if gap < 2 * radius:
            drawing.disc(site, 1.9 * radius, colors[i])
            drawing.disc(site, 1.9 * radius - 1.2, tone.view)
        else:
            drawing.add(Stroke(_circle(site, 1.9 * radius - 0.6), tone.text_2, 1.2))
    for at, color in zip(frames, colors):
        drawing.disc(at, 1.28 * radius, tone.view)
        drawing.disc(at, radius, color)


def _bad(graph: Graph, signals: Signals, bad: Sequence[int], crowd: Crowd) -> None:
    color = WARNING[graph.tone.name]
    middles = signals.time(signals.ticks((np.asarray(bad, dtype=float) + 0.5) / signals.fps))
    for i, at in zip(bad, graph.place(middles[:, 0], middles[:, 1])):
        graph.drawing.add(Stroke(_circle(at, 14.0), color, 1.8, (4, 4)))
        _label(graph, crowd, f"{i}-{i + 1}", at, (15.0, 22.0), color)


def _circle(at: FloatArray, radius: float) -> FloatArray:
    around = np.linspace(0, 2 * np.pi, 49)
    return at + radius * np.column_stack([np.cos(around), np.sin(around)])


def _frame_numbers(graph: Graph, signals: Signals, frames: FloatArray, crowd: Crowd) -> None:
    colors = time_colors(signals.times, signals.duration, graph.tone)
    step = _label_step(len(frames))
    last = len(frames) - 1
    for i in [*range(0, last - step // 2, step), last]:
        ink = "#" + "".join(f"{round(255 * c):02x}" for c in colors[i])
        _label(graph, crowd, str(i), frames[i], (9.0, 13.0), ink)


def _label_step(count: int, most: int = 24) -> int:
    return next(s for s in (1, 2, 3, 5, 10, 20, 25, 50, 100, 200, 500, 1000, 10**9) if s * most >= count)


def _controls(graph: Graph, controls: FloatArray) -> None:
    half = 4.2 if len(controls) <= 60 else 2.6
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])
    for at in controls:
        graph.drawing.add(Stroke(at + corners, graph.tone.text_2, 1.3))


def _control_numbers(graph: Graph, controls: FloatArray, crowd: Crowd) -> None:
    step = _label_step(len(controls), most=48)
    for j, at in _inside(graph, controls).items():
        if j % step == 0:
            _label(graph, crowd, str(j), at, (6.0, 9.0, 12.0), graph.tone.text_3, size=9.5)


def _inside(graph: Graph, points: FloatArray) -> dict[int, FloatArray]:
    left, top, right, bottom = graph.box
    return {j: at for j, at in enumerate(points) if left < at[0] < right and top < at[1] < bottom}


def _label(
    graph: Graph,
    crowd: Crowd,
    text: str,
    anchor: FloatArray,
    distances: tuple[float, ...],
    color: str,
    size: float = 12.0,
) -> None:
    at = crowd.settle(anchor, (text_width(text, size) / 2 + 1, 0.5 * size), distances, limit=1.0)
    if at is not None:
        graph.drawing.add(
            Words(text, (float(at[0]), float(at[1])), size, color, "middle", graph.drawing.background)
        )


def _legend(graph: Graph, signals: Signals, bad: bool) -> None:
    tone, drawing = graph.tone, graph.drawing
    x, y = graph.box[0] + 6, graph.box[3] + 44
    middle = time_colors(np.array([0.4]), 1.0, tone)[0]
    drawing.disc((x, y), 3.6, middle)
    x = _entry(graph, "frame", x + 10, y)
    drawing.disc((x, y), 7.2, middle)
    drawing.disc((x, y), 6.0, tone.view)
    drawing.disc((x, y), 3.6, middle)
    x = _entry(graph, "site", x + 12, y)
    _controls(graph, np.array([[x, y]]))
    x = _entry(graph, "control point", x + 10, y)
    if bad:
        drawing.add(Stroke(_circle(np.array([x, y]), 7.5), WARNING[tone.name], 1.8, (4, 4)))
        x = _entry(graph, "bad transition", x + 13, y)
    if (signals.time.curve.controls != signals.time.unedited.controls).any():
        drawing.add(Stroke(np.array([[x - 4, y], [x + 18, y]]), tone.text_3, 1.4, (4, 5)))
        x = _entry(graph, "before edits", x + 24, y)
    _time_bar(graph, signals, y)


def _entry(graph: Graph, text: str, x: float, y: float) -> float:
    graph.drawing.add(Words(text, (x, y), 11.5, graph.tone.text_2))
    return x + text_width(text, 11.5) + 24


def _time_bar(graph: Graph, signals: Signals, y: float) -> None:
    right, tone = graph.box[2], graph.tone
    last = f"{signals.duration:.3g} s"
    graph.drawing.add(Words(last, (right, y), 11.5, tone.text_2, "end"))
    end = right - text_width(last, 11.5) - 8
    stops = np.column_stack([np.linspace(end - 106, end - 4, 33), np.full(33, y)])
    graph.drawing.add(Stroke(stops, time_colors(np.linspace(0, 1, 33), 1.0, tone), 8.0))
    graph.drawing.add(Words("0 s", (end - 118, y), 11.5, tone.text_2, "end"))
