"""A contact sheet: moments of clips side by side, from more than one side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.render.camera import Camera
from tempose.render.colors import Picture, ramp_colors
from tempose.render.follow import clip_cameras, good_aspect
from tempose.render.frame import render_frame
from tempose.render.layout import Legend, Row, lay_out
from tempose.render.subject import as_clip, floor_level, frame_choice, wire_of
from tempose.render.themes import Theme, theme_named
from tempose.render.views import view_label
from tempose.render.workers import in_order
from tempose.typing import Progress, silent


def contact_sheet(
    clips: Mesh | MeshClip | Sequence[Mesh | MeshClip],
    frames: int | Sequence[int] = 8,
    views: Sequence[str | float | tuple[float, float]] = ("front", "side"),
    *,
    cell: int | tuple[int, int] = 300,
    title: str = "",
    names: Sequence[str] | None = None,
    theme: str | Theme = "light",
    ground: float | str | None = "auto",
    track: bool | None = None,
    elevation: float | None = np.radians(9.0),
    cameras: Callable[[int, int, int], Camera] | None = None,
    scalars: Any = None,
    scalar_range: tuple[float, float] | None = None,
    scalar_label: str = "",
    ramp: str = "heat",
    segments: Any = None,
    points: Any = None,
    workers: int | None = None,
    progress: Progress = silent,
    **look: Any,
) -> Picture:
    """Render moments of clips into one picture: a row for each clip and view, a column for each moment.

    Parameters
    ----------
    clips : Mesh, MeshClip or sequence of them
        What to show. Several clips are matched by time from their first to their last frame.
    frames : int or sequence of int, default 8
        How many columns; or which frames (of each clip).
    views : sequence, default ("front", "side")
        Names, azimuths, or azimuth and elevation in radians.
    cell : int or (int, int), default 300
        Height of a cell in pixels, its width following the model; or width and height.
    title : str
        Line above the sheet.
    names : sequence of str, optional
        A name per clip, for the captions of rows; else their own.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    ground : float, "auto" or None, default "auto"
        Height of the floor; ``"auto"`` by `ground_level`, None for no floor.
    track : bool, optional
        Whether the camera goes with the model; None decides by how far it travels.
    elevation : float, optional
        Radians above the horizon for every view but the top; None takes that of the view.
    cameras : callable, optional
        Camera for clip number, view number and frame; takes the place of `track` and `elevation`.
    scalars : (T, n) or (n,) array_like, or a sequence of these and None per clip, optional
        Numbers shown as colours, with a legend.
    scalar_range : (float, float), optional
        Numbers of the first and last colour; else the least and the greatest shown.
    scalar_label : str
        Name and unit of the numbers.
    ramp : str, default "heat"
        Name out of `tempose.render.RAMPS`.
    segments : (T, k, 2, 3) array_like, or a sequence of these and None per clip, optional
        Bones drawn over the frames, metres.
    points : (T, p, 3) array_like, or a sequence of these and None per clip, optional
        Markers drawn over the frames, metres.
    workers : int, optional
        Cells rendered at a time; None for one per core, at most four.
    progress : Progress, default silent
        Called after each cell.
    **look
        Passed to `render_frame`: ``quality``, ``wire``, ``crease``, ``colors``, ``line_colors``...

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.

    Raises
    ------
    ValueError
        If a frame or a view does not exist or an array has another shape.
    """
    several = not isinstance(clips, (Mesh, MeshClip))
    shown = [as_clip(c) for c in ([clips] if isinstance(clips, (Mesh, MeshClip)) else clips)]
    tone = theme_named(theme)
    chosen = [frame_choice(frames, clip.n_frames) for clip in shown]
    values = _per_clip(scalars, shown, several, "scalars", 2)
    span = _span(values, chosen, scalar_range)
    bones = _per_clip(segments, shown, several, "segments", 4)
    marks = _per_clip(points, shown, several, "points", 3)
    size = _cell_size(cell, shown, views)
    floors = [floor_level(clip, ground) for clip in shown]
    paths = _paths(shown, views, size, track, elevation)

    def picture(at: tuple[int, int, int]) -> Picture:
        c, v, t = at
        options = look | {"wire": wire_of(shown[c].mesh, look.get("wire", False))}
        if values[c] is not None and span is not None:
            options["colors"] = ramp_colors(values[c][t], *span, ramp)
        for key, array in (("lines", bones[c]), ("points", marks[c])):
            if array is not None:
                options[key] = array[t]
        camera = paths[c, v][t] if cameras is None else cameras(c, v, t)
        V, F = shown[c].vertices[t], shown[c].faces
        return render_frame(V, F, camera, size=size, theme=tone, ground=floors[c], **options)

    cells = [(c, v, t) for c in range(len(shown)) for v in range(len(views)) for t in chosen[c]]
    pictures: dict[tuple[int, int, int], Picture] = {}
    for at, done in zip(cells, in_order(picture, cells, workers)):
        pictures[at] = done
        progress(len(pictures), len(cells), "rendering")
    rows = _rows(pictures, chosen, shown, views, names)
    return lay_out(rows, title, tone, None if span is None else Legend(*span, scalar_label, ramp))


def _rows(
    pictures: dict[tuple[int, int, int], Picture],
    chosen: list[list[int]],
    clips: list[MeshClip],
    views: Sequence[Any],
    names: Sequence[str] | None,
) -> list[Row]:
    labels = names or [clip.name for clip in clips]
    return [
        Row(
            [pictures[c, v, t] for t in chosen[c]],
            [f"{t}   {t / clip.fps:.2f} s" for t in chosen[c]],
            " · ".join(w for w in (labels[c], view_label(view)) if w),
        )
        for c, clip in enumerate(clips)
        for v, view in enumerate(views)
    ]


def _paths(
    clips: list[MeshClip],
    views: Sequence[Any],
    size: tuple[int, int],
    track: bool | None,
    elevation: float | None,
) -> dict[tuple[int, int], list[Camera]]:
    paths: dict[tuple[int, int], list[Camera]] = {}
    for c, clip in enumerate(clips):
        for v, view in enumerate(views):
            up = None if view == "top" or isinstance(view, tuple) else elevation
            paths[c, v] = clip_cameras(
                clip, view, aspect=size[0] / size[1], track=track, elevation=up, roam=0.2
            )
    return paths


def _cell_size(cell: int | tuple[int, int], clips: list[MeshClip], views: Sequence[Any]) -> tuple[int, int]:
    if not isinstance(cell, (int, np.integer)):
        return int(cell[0]), int(cell[1])
    aspect = max(good_aspect(clip, view, 0.5, 1.8) for clip in clips for view in views)
    return int(round(cell * aspect)), int(cell)


def _per_clip(value: Any, clips: list[MeshClip], several: bool, name: str, ndim: int) -> list[Any]:
    if value is None:
        return [None] * len(clips)
    given = list(value) if several else [value]
    if len(given) != len(clips):
        raise ValueError(f"{name} must hold one array for each of the {len(clips)} clips, got {len(given)}")
    out: list[Any] = []
    for array, clip in zip(given, clips):
        if array is None:
            out.append(None)
            continue
        A = np.asarray(array, dtype=np.float64)
        if A.ndim == ndim - 1:
            A = np.broadcast_to(A, (clip.n_frames, *A.shape))
        if A.ndim != ndim or len(A) != clip.n_frames:
            raise ValueError(
                f"{name} must have one entry for each of {clip.n_frames} frames, got shape {A.shape}"
            )
        out.append(A)
    return out


def _span(
    values: list[Any], chosen: list[list[int]], given: tuple[float, float] | None
) -> tuple[float, float] | None:
    shown = [v[t] for v, frames in zip(values, chosen) if v is not None for t in frames]
    if not shown:
        return None
    if given is not None:
        return float(given[0]), float(given[1])
    low, high = min(float(np.nanmin(v)) for v in shown), max(float(np.nanmax(v)) for v in shown)
    return low, high if high > low else low + 1.0
