"""Lay charts side by side in the unit square."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.typing import FloatArray, IntArray

GAP = 0.004
"""Least distance between charts, in the unit square: four texels of a 1024 texture."""


def pack_charts(charts: Sequence[FloatArray]) -> list[FloatArray]:
    """Place charts in the unit square, all at one scale, without overlap.

    Parameters
    ----------
    charts : sequence of (k, 2) float
        Texture coordinates of each chart in one unit of length.

    Returns
    -------
    list of (k, 2) ndarray
        The same, turned upright and moved into rows, then scaled to fit.
    """
    upright = [_upright(uv) for uv in charts]
    sizes = np.array([uv.max(axis=0) for uv in upright])
    order = np.argsort(-sizes[:, 1], kind="stable")
    low, high = float(sizes[:, 0].max()), float(sizes[:, 0].max() + np.sqrt((sizes.prod(axis=1)).sum()) * 2.0)
    widths = np.linspace(low, high, 60)
    sides = [_rows(sizes, order, width)[1] for width in widths]
    best = int(np.argmin(sides))
    corners, side = _rows(sizes, order, float(widths[best]))
    return [(uv + corner) / side for uv, corner in zip(upright, corners)]


def _rows(sizes: FloatArray, order: IntArray, width: float) -> tuple[FloatArray, float]:
    """Fill rows from the tallest chart to the flattest; the side of the square that they need."""
    gap = GAP * max(width, float(np.sqrt(sizes.prod(axis=1).sum())))
    corners = np.zeros(sizes.shape)
    x, y, height, widest = gap, gap, 0.0, 0.0
    for i in order:
        if x + sizes[i, 0] > width and x > gap:
            x, y, height = gap, y + height + gap, 0.0
        corners[i] = x, y
        x += sizes[i, 0] + gap
        height, widest = max(height, sizes[i, 1]), max(widest, x)
    return corners, max(widest, y + height + gap)


def _upright(uv: FloatArray) -> FloatArray:
    """Turn a chart so that its box is smallest and taller than wide, with a corner at the origin."""
    angles = np.linspace(0.0, np.pi / 2.0, 46)[:-1]
    turned = [uv @ _rotation(a).T for a in angles]
    best = turned[int(np.argmin([float(np.ptp(t, axis=0).prod()) for t in turned]))]
    if np.ptp(best[:, 0]) > np.ptp(best[:, 1]):
        best = best @ _rotation(np.pi / 2.0).T
    return best - best.min(axis=0)


def _rotation(angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])
