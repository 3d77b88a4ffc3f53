"""A contact sheet: moments of clips side by side, from more than one side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.render.camera import Camera
from tempose.render.colors import Picture, ramp_colors
from tempose.render.follow import as_clip, clip_cameras, floor_level, frame_choice, good_aspect
from tempose.render.frame import render_frame
from tempose.render.text import draw_text, text_size
from tempose.render.themes import Theme, rgb, theme_named
from tempose.typing import Progress, silent

PAD, CAPTION, TITLE = 10, 13, 17


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
    shown = [as_clip(c) for c in clips] if not isinstance(clips, (Mesh, MeshClip)) else [as_clip(clips)]
    tone = theme_named(theme)
    chosen = [frame_choice(frames, clip.n_frames) for clip in shown]
    values = _per_clip(scalars, shown, several, "scalars", 2)
    span = _span(values, scalar_range)
    bones, marks = (
        _per_clip(segments, shown, several, "segments", 4),
        _per_clip(points, shown, several, "points", 3),
    )
    if isinstance(cell, int):
        aspect = max(good_aspect(c, v, 0.45, 1.9) for c in shown for v in views)
        size = (int(round(cell * aspect)), cell)
    else:
        size = (int(cell[0]), int(cell[1]))
    rows: list[list[Picture]] = []
    total = len(views) * sum(len(c) for c in chosen)
    for c, clip in enumerate(shown):
        level = floor_level(clip, ground)
        for v, view in enumerate(views):
            up = elevation if view != "top" and not isinstance(view, tuple) else None
            path = clip_cameras(clip, view, aspect=size[0] / size[1], track=track, elevation=up, roam=0.2)
            row: list[Picture] = []
            for t in chosen[c]:
                camera = path[t] if cameras is None else cameras(c, v, t)
                options = dict(look)
                if values[c] is not None and span is not None:
                    options["colors"] = ramp_colors(values[c][t], *span, ramp)
                for key, array in (("lines", bones[c]), ("points", marks[c])):
                    if array is not None:
                        options[key] = array[t]
                row.append(
                    render_frame(
                        clip.vertices[t], clip.faces, camera, size=size, theme=tone, ground=level, **options
                    )
                )
                progress(sum(len(r) for r in rows) + len(row), total, "rendering")
            rows.append(row)
    captions = [[f"{t}   {t / clip.fps:.2f} s" for t in chosen[c]] for c, clip in enumerate(shown)]
    labels = names if names is not None else [clip.name for clip in shown]
    return _assembled(rows, captions, labels, views, title, tone, (span, scalar_label, ramp))


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


def _span(values: list[Any], given: tuple[float, float] | None) -> tuple[float, float] | None:
    known = [v for v in values if v is not None]
    if not known:
        return None
    if given is not None:
        return float(given[0]), float(given[1])
    low, high = min(float(np.nanmin(v)) for v in known), max(float(np.nanmax(v)) for v in known)
    return low, high if high > low else low + 1.0


def _assembled(
    rows: list[list[Picture]],
    captions: list[list[str]],
    labels: Sequence[str],
    views: Sequence[Any],
    title: str,
    tone: Theme,
    legend: tuple[tuple[float, float] | None, str, str],
) -> Picture:
    height, width = rows[0][0].shape[:2]
    columns = max(len(row) for row in rows)
    strip = CAPTION + 8
    top = PAD + (TITLE + 10 if title or legend[0] else 0)
    sheet = np.zeros(
        (top + len(rows) * (height + strip + 4) + PAD, 2 * PAD + columns * (width + 4) - 4, 3), np.uint8
    )
    sheet[:] = np.round(rgb(tone.panel) * 255).astype(np.uint8)
    if title:
        draw_text(sheet, title, (PAD, PAD), TITLE, rgb(tone.text))
    if legend[0] is not None:
        _draw_legend(sheet, legend[0], legend[1], legend[2], tone)
    for r, row in enumerate(rows):
        y = top + r * (height + strip + 4)
        clip, view = divmod(r, len(views))
        for c, picture in enumerate(row):
            x = PAD + c * (width + 4)
            sheet[y : y + height, x : x + width] = picture
            draw_text(sheet, captions[clip][c], (x + 2, y + height + 3), CAPTION, rgb(tone.text_2))
        words = [w for w in (labels[clip], _view_name(views[view])) if w]
        draw_text(sheet, " · ".join(words), (PAD + 8, y + 6), CAPTION, rgb(tone.text_3))
    return sheet


def _view_name(view: Any) -> str:
    if isinstance(view, str):
        return view
    azimuth = view[0] if isinstance(view, tuple) else view
    return f"{np.degrees(azimuth):.0f}°"


def _draw_legend(sheet: Picture, span: tuple[float, float], label: str, ramp: str, tone: Theme) -> None:
    width = 140
    right = sheet.shape[1] - PAD
    high, low = f"{span[1]:.3g}", f"{span[0]:.3g}"
    x1 = right - text_size(high, CAPTION)[0] - 6
    x0 = x1 - width
    bar = ramp_colors(np.linspace(0, 1, width), 0, 1, ramp)
    sheet[PAD + 4 : PAD + 14, x0:x1] = np.round(bar * 255).astype(np.uint8)[None]
    draw_text(sheet, high, (right, PAD + 9), CAPTION, rgb(tone.text_2), anchor="rm")
    draw_text(sheet, f"{label}  {low}".strip(), (x0 - 6, PAD + 9), CAPTION, rgb(tone.text_2), anchor="rm")
