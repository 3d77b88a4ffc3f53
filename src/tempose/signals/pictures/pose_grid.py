"""Small pictures of the pose signal over the pose plane, finer where one looks closer."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.render import Theme
from tempose.render.drawing import Drawing, Inset, Stroke
from tempose.render.themes import theme_named
from tempose.signals.pictures.pose_plane import draw_plane_axes, time_colors
from tempose.signals.pictures.region import Region, check_region, curve_points, plane_graph, used_region
from tempose.signals.pictures.thumbnails import make_studio
from tempose.signals.pictures.trust import make_trust
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, Progress, silent


def draw_pose_grid(
    signals: Signals,
    region: Region | None = None,
    *,
    columns: int = 9,
    view: tuple[float, float] | None = None,
    title: str = "",
    theme: str | Theme = "light",
    progress: Progress = silent,
) -> Drawing:
    """Draw what every place of the pose plane means, as the paper's last section wishes for.

    Poses that stretch edges as the clip never does, or lie far from its curve, are shown faintly: they
    are extrapolated. A small region gets as many pictures as the whole plane: it is shown finer.

    Parameters
    ----------
    signals : Signals
        A clip.
    region : (float, float, float, float), optional
        Least x, least y, greatest x, greatest y shown; None shows all that the curve uses.
    columns : int, default 9
        Pictures along the longer side.
    view : (float, float), optional
        Azimuth and elevation, radians; None looks from where most of the motion is seen.
    title : str
        A line above.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    progress : Progress, default silent
        Called after each picture.

    Returns
    -------
    Drawing
        For `tempose.render.save_drawing`.

    Raises
    ------
    ValueError
        If the region is empty, or there are fewer than 2 or more than 60 columns.
    """
    if not 2 <= columns <= 60:
        raise ValueError(f"columns must be 2 to 60, got {columns}")
    tone = theme_named(theme)
    graph = plane_graph(used_region(signals) if region is None else check_region(region), tone)
    draw_plane_axes(graph, title)
    left, top, right, bottom = graph.box
    cell = max(right - left, bottom - top) / columns
    across, down = max(round((right - left) / cell), 1), max(round((bottom - top) / cell), 1)
    x = np.linspace(*graph.x_range, 2 * across + 1)[1::2]
    y = np.linspace(*graph.y_range, 2 * down + 1)[-2::-2]
    P = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    V = poses_at(signals, P)
    seen = signals.shape.vertices(signals.coordinates(signals.times[:: max(signals.n_frames // 24, 1)]))
    studio, trust = (
        make_studio(seen, tone, (round(0.94 * cell), round(0.94 * cell)), view),
        make_trust(signals),
    )
    for i, (p, v) in enumerate(zip(P, V)):
        picture = studio.picture(v, signals.mesh.faces)
        picture[..., 3] = np.round(picture[..., 3] * trust.strength(p, v)).astype(np.uint8)
        at = graph.place(*p)
        graph.drawing.add(Inset(picture, (float(at[0]), float(at[1])), studio.size))
        progress(i + 1, len(P), "drawing poses")
    seconds, curve = curve_points(signals)
    for points, colors in _visible(
        graph.place(*curve.T), time_colors(seconds, signals.duration, tone), graph.box
    ):
        graph.drawing.add(Stroke(points, colors, 2.4, opacity=0.85))
    return graph.drawing


def poses_at(signals: Signals, P: FloatArray) -> FloatArray:
    """Return the meshes at places of the pose plane.

    Parameters
    ----------
    signals : Signals
        A clip.
    P : (k, 2) float
        Places.

    Returns
    -------
    (k, n, 3) ndarray
        h(g(p)), metres. Where the pose signal is made of windows, that of the nearest point of the curve.
    """
    seconds, curve = curve_points(signals)
    ticks = signals.ticks(seconds[KDTree(curve).query(P)[1]])
    captured = ticks if signals.origin is None else signals.origin(ticks)
    return signals.shape.vertices(signals.pose(P, captured))


def _visible(
    points: FloatArray, colors: FloatArray, box: tuple[float, float, float, float]
) -> list[tuple[FloatArray, FloatArray]]:
    inside = ((points >= box[:2]) & (points <= box[2:])).all(axis=1)
    cuts = np.flatnonzero(np.diff(inside.astype(int))) + 1
    parts = zip(np.split(points, cuts), np.split(colors, cuts), np.split(inside, cuts))
    return [(p, c) for p, c, there in parts if there[0]]
