"""All pictures of a model, in a folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tempose.render import Theme
from tempose.render.colors import Picture
from tempose.render.drawing import Drawing, save_drawing
from tempose.render.drawing_raster import drawing_picture
from tempose.signals.model import SignalModel
from tempose.signals.pictures.charts import draw_errors, draw_retiming, draw_scree
from tempose.signals.pictures.pose_grid import draw_pose_grid
from tempose.signals.pictures.pose_plane import draw_pose_plane
from tempose.signals.pictures.region import Region
from tempose.signals.pose.transitions import find_bad_transitions
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, Progress, silent

NAMES = {"h": "shape", "hg": "shape + pose", "hgf": "shape + pose + time", "played": "played"}
"""What the rows of ``frame_errors`` are called in pictures."""


def plot_signals(
    model: SignalModel,
    folder: str | os.PathLike[str],
    *,
    formats: tuple[str, ...] = ("png", "svg"),
    theme: str | Theme = "light",
    grid: bool = True,
    progress: Progress = silent,
) -> list[Path]:
    """Draw a model: its pose plane, what places in it mean, errors, what h leaves out, its clock.

    Parameters
    ----------
    model : SignalModel
        Fitted, edited or loaded.
    folder : path-like
        Where the pictures go; made if its parent exists. Files of the same names are replaced.
    formats : tuple of str, default ("png", "svg")
        ``"png"``, ``"svg"`` or both.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    grid : bool, default True
        Whether to draw the grid of poses, which takes longest.
    progress : Progress, default silent
        Called after each picture.

    Returns
    -------
    list of Path
        ``pose-plane``, ``pose-grid``, ``frame-errors``, ``scree`` and, where edits changed the clock,
        ``retiming``.

    Raises
    ------
    ValueError
        If a format is another.
    OSError
        If the folder cannot be made or written.
    """
    for name in formats:
        if name not in ("png", "svg"):
            raise ValueError(f"formats must be 'png' or 'svg', got {name!r}")
    place = Path(folder)
    place.mkdir(exist_ok=True)
    drawers = _drawers(model, theme, grid, progress)
    written: list[Path] = []
    for i, (name, draw) in enumerate(drawers.items()):
        drawing = draw()
        for suffix in formats if name != "pose-grid" else ("png",):  # pictures gain nothing from SVG
            written.append(place / f"{name}.{suffix}")
            save_drawing(drawing, written[-1])
        progress(i + 1, len(drawers), "drawing pictures")
    return written


def _drawers(
    model: SignalModel, theme: str | Theme, grid: bool, progress: Progress
) -> dict[str, Callable[[], Drawing]]:
    signals, report = model.signals_, model.report_
    found: dict[str, Callable[[], Drawing]] = {
        "pose-plane": lambda: draw_pose_plane(signals, bad=bad_transitions(signals), theme=theme)
    }
    if grid:
        found["pose-grid"] = lambda: draw_pose_grid(signals, theme=theme, progress=progress)
    tolerance: Any = report.get("options", {}).get("tolerance")
    if report.get("frame_errors") and not model.edits_:
        errors = named_errors(report["frame_errors"])
        found["frame-errors"] = lambda: draw_errors(errors, tolerance, theme)
    if report.get("scree"):
        found["scree"] = lambda: draw_scree(np.asarray(report["scree"]), report["m"], tolerance, theme)
    if signals.retimings:
        found["retiming"] = lambda: draw_retiming(signals, theme)
    return found


def named_errors(rows: Mapping[str, list[float]]) -> Mapping[str, FloatArray]:
    """Name the rows of ``frame_errors`` as charts do.

    Parameters
    ----------
    rows : mapping of str to list of T floats
        Of a report.

    Returns
    -------
    mapping of str to (T,) ndarray
        What is played last; the shape signal alone is left out where it is what is played.
    """
    errors = {name: np.asarray(row, dtype=np.float64) for name, row in rows.items()}
    if np.allclose(errors.get("h", 0.0), errors["played"], rtol=1e-3, atol=1e-9):
        del errors["h"]  # one line would hide the other
        return {NAMES[name]: errors[name] for name in ("hg", "hgf")} | {"played = shape": errors["played"]}
    return {NAMES[name]: row for name, row in errors.items()}


def bad_transitions(signals: Signals) -> list[int]:
    """Find the frames after which the pose signal strays from the time spline.

    Parameters
    ----------
    signals : Signals
        A clip. One that is played without a time spline has nothing to compare with.

    Returns
    -------
    list of int
        Frames of the curve, whole ticks.
    """
    if signals.path is None:
        return []
    ticks = np.arange(int(np.floor(signals.path.domain[1] + 1e-9)) + 1, dtype=np.float64)
    captured = signals.origin
    X = signals.path(ticks)

    def pose(p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        at = ticks[:-1] + 0.5 if origin is None else origin
        return signals.pose(p, at if captured is None else captured(at))

    found = find_bad_transitions(pose, signals.time.before_edits, X, path=signals.path)
    return [int(i) for i in np.flatnonzero(found.bad)]


def pose_grid(
    model: SignalModel,
    region: Region | None = None,
    *,
    columns: int = 9,
    view: tuple[float, float] | None = None,
    theme: str | Theme = "light",
    scale: float = 2.0,
    progress: Progress = silent,
) -> Picture:
    """Show what every place of the pose plane means, in one picture.

    Parameters
    ----------
    model : SignalModel
        Fitted, edited or loaded.
    region : (float, float, float, float), optional
        Least x, least y, greatest x, greatest y shown; a small region is shown finer. None shows all.
    columns : int, default 9
        Small pictures along the longer side.
    view : (float, float), optional
        Azimuth and elevation, radians; None looks from where most of the motion is seen.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    scale : float, default 2
        Pixels for each of some 830 across.
    progress : Progress, default silent
        Called after each small picture.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture; poses that no frame is near to are fainter.

    Raises
    ------
    ValueError
        If the region is empty or `columns` is out of range.
    """
    drawing = draw_pose_grid(
        model.signals_, region, columns=columns, view=view, theme=theme, progress=progress
    )
    return drawing_picture(drawing, scale)
