"""Which part of the pose plane a picture shows."""

from __future__ import annotations

import numpy as np

from tempose.render import Theme
from tempose.render.drawing import Drawing
from tempose.render.graph import Graph
from tempose.signals.signals import Signals
from tempose.typing import FloatArray

Region = tuple[float, float, float, float]
"""Least x, least y, greatest x, greatest y, in units of the pose plane."""
WARNING = {"dark": "#e9c64b", "light": "#9a7400"}
"""Colour of what needs care, by the name of the theme."""
ROUND_CONTROLS = 0.06
"""Share of the longer side that is left round a control point."""
_LONGEST, _MARGINS = 760.0, (52.0, 24.0, 24.0, 78.0)


def used_region(signals: Signals, margin: float = 0.16, *, controls: bool = False) -> Region:
    """Return the part of the plane that the curve, the frames and the sites fill.

    Parameters
    ----------
    signals : Signals
        A clip.
    margin : float, default 0.16
        What is added on each side, as a share of the longer side.
    controls : bool, default False
        Whether control points count, too, that lie outside by no more than half the longer side.

    Returns
    -------
    Region
        Of some extent in both directions, also where the curve is a line or a point.
    """
    shown = np.concatenate([curve_points(signals)[1], signals.pose.sites])
    low, high = shown.min(axis=0), shown.max(axis=0)
    side = max(float((high - low).max()), 1e-9)
    if controls:
        points = signals.time.curve.controls
        inset = (margin - ROUND_CONTROLS) * side
        near = points[((points > low - 0.5 * side) & (points < high + 0.5 * side)).all(axis=1)]
        low = np.minimum(low, near.min(axis=0, initial=np.inf) + inset)
        high = np.maximum(high, near.max(axis=0, initial=-np.inf) - inset)
    grow = np.maximum(margin * side, (0.45 * side - (high - low)) / 2)
    (x0, y0), (x1, y1) = low - grow, high + grow
    return float(x0), float(y0), float(x1), float(y1)


def curve_points(signals: Signals, most: int = 4000) -> tuple[FloatArray, FloatArray]:
    """Sample the curve that is played, densely enough to look smooth.

    Parameters
    ----------
    signals : Signals
        A clip.
    most : int, default 4000
        Samples at most.

    Returns
    -------
    (s,) ndarray, (s, 2) ndarray
        Seconds and places in the pose plane.
    """
    seconds = np.linspace(0.0, signals.duration, min(24 * max(signals.n_frames - 1, 1) + 1, most))
    return seconds, signals.time(signals.ticks(seconds))


def plane_graph(region: Region, tone: Theme) -> Graph:
    """Start a drawing of the pose plane, one scale for both directions.

    Parameters
    ----------
    region : Region
        What is shown.
    tone : Theme
        Colours.

    Returns
    -------
    Graph
        In a drawing of its own, without axes.
    """
    x0, y0, x1, y1 = region
    scale = _LONGEST / max(x1 - x0, y1 - y0)
    left, top, right, bottom = _MARGINS
    width, height = scale * (x1 - x0), scale * (y1 - y0)
    drawing = Drawing(round(left + width + right), round(top + height + bottom), tone.view)
    box = (left, top, left + width, top + height)
    return Graph(drawing, tone, box, (x0, x1), (y0, y1))


def check_region(region: Region) -> Region:
    """Check a part of the plane.

    Parameters
    ----------
    region : Region
        As a caller gave it.

    Returns
    -------
    Region
        The same, as numbers.

    Raises
    ------
    ValueError
        If it is not four finite numbers, or empty.
    """
    numbers = tuple(float(v) for v in region)
    if len(numbers) != 4 or not np.isfinite(numbers).all():
        raise ValueError(f"region must be x0, y0, x1, y1, four numbers, got {region}")
    x0, y0, x1, y1 = numbers
    if not (x0 < x1 and y0 < y1):
        raise ValueError(f"region must go from low to high in x and in y, got {region}")
    return x0, y0, x1, y1
