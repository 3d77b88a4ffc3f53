"""Makers of the solids and brush strokes that characters are sculpted from."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.samples.parts import ELLIPSOID, LOFT, ROUND_CONE, SWELL, Part, Point, frame
from tempose.samples.primitives import TABLE_ROWS


def cone(
    node: str, a: Point, b: Point, radii: tuple[float, float], blend: float, detail: float = 1.0
) -> Part:
    """Round cone between two points.

    Parameters
    ----------
    node : str
        Node it belongs to.
    a, b : (3,) float
        Centres of the balls at its ends, metres.
    radii : (float, float)
        Their radii, metres.
    blend : float
        Fillet radius, metres.
    detail : float, default 1
        Relative edge length.

    Returns
    -------
    Part
        The part.
    """
    return Part(node, ROUND_CONE, np.array([*a, *b, *radii], dtype=np.float64), blend, detail)


def ellipsoid(
    node: str,
    centre: Point,
    radii: Point,
    blend: float,
    *,
    along: Point = (0.0, 0.0, 1.0),
    up: Point = (0.0, 1.0, 0.0),
    detail: float = 1.0,
    carve: bool = False,
) -> Part:
    """Ellipsoid with its third axis along a direction.

    Parameters
    ----------
    node : str
        Node it belongs to.
    centre : (3,) float
        Centre, metres.
    radii : (3,) float
        Radii across, up and along, metres.
    blend : float
        Fillet radius, metres.
    along, up : (3,) float
        Direction of the third axis, and roughly of the second.
    detail : float, default 1
        Relative edge length.
    carve : bool, default False
        Take away instead of adding.

    Returns
    -------
    Part
        The part.
    """
    axes = frame(along, up)
    return Part(
        node, ELLIPSOID, np.array([*centre, *axes.ravel(), *radii], dtype=np.float64), blend, detail, carve
    )


def swell(
    node: str,
    centre: Point,
    radii: Point,
    height: float,
    *,
    along: Point = (0.0, 0.0, 1.0),
    up: Point = (0.0, 1.0, 0.0),
) -> Part:
    """Brush stroke: a smooth bump or dent over the parts of the node so far.

    Parameters
    ----------
    node : str
        Node it belongs to.
    centre : (3,) float
        Centre of the stroke, metres.
    radii : (3,) float
        Reach across, up and along, metres.
    height : float
        Height of the bump, negative for a dent, metres.
    along, up : (3,) float
        Direction of the third axis, and roughly of the second.

    Returns
    -------
    Part
        The part.
    """
    data = np.array([*centre, *frame(along, up).ravel(), *radii, height], dtype=np.float64)
    return Part(node, SWELL, data, 0.0)


def loft(
    node: str,
    start: Point,
    end: Point,
    front: Point,
    sections: Sequence[Sequence[float]],
    blend: float,
    *,
    caps: tuple[float, float] = (0.02, 0.02),
    folds: tuple[float, float] = (0.0, 0.0),
    detail: float = 1.0,
    carve: bool = False,
    thickness: float = np.inf,
) -> Part:
    """Sweep of superellipses along a straight line.

    Parameters
    ----------
    node : str
        Node it belongs to.
    start, end : (3,) float
        Ends of the axis, metres.
    front : (3,) float
        Direction of +v, roughly; +u is ``front x axis``.
    sections : sequence of (9,) float
        Place along the axis (0 to 1), then one row of the table of `primitives.loft`.
    blend : float
        Fillet radius, metres.
    caps : (float, float)
        Heights of the rounded ends, metres.
    folds : (float, float)
        Folds around the axis, and their phase.
    detail : float, default 1
        Relative edge length.
    carve : bool, default False
        Take away instead of adding.
    thickness : float, optional
        Half of what must not vanish when triangles are few, metres.

    Returns
    -------
    Part
        The part.
    """
    start, end = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    axes = frame(end - start, front)
    rows = np.asarray(sections, dtype=np.float64)
    table = CubicSpline(rows[:, 0], rows[:, 1:])(np.linspace(0.0, 1.0, TABLE_ROWS))
    length = float(np.linalg.norm(end - start))
    data = np.array([*start, *axes.ravel(), length, *caps, *folds], dtype=np.float64)
    return Part(node, LOFT, data, blend, detail, carve, np.asarray(table, dtype=np.float64), thickness)
