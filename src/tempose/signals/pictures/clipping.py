"""Lines cut at the edge of a rectangle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tempose.typing import FloatArray


def clipped(points: FloatArray, box: tuple[float, float, float, float]) -> list[FloatArray]:
    """Cut a line to what lies inside a rectangle.

    Parameters
    ----------
    points : (n, 2) float
        The line.
    box : (float, float, float, float)
        Least x, least y, greatest x, greatest y.

    Returns
    -------
    list of (2, 2) ndarray
        The visible part of each of its segments, in order.
    """
    low, high = np.array(box[:2]), np.array(box[2:])
    parts: list[FloatArray] = []
    for a, b in pairwise(points):
        d = b - a
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.stack([(low - a) / d, (high - a) / d])
        inside = (a >= low) & (a <= high)
        enter = np.where(d == 0, np.where(inside, 0.0, 2.0), t.min(axis=0))
        leave = np.where(d == 0, np.where(inside, 1.0, -1.0), t.max(axis=0))
        t0, t1 = max(0.0, float(enter.max())), min(1.0, float(leave.min()))
        if t0 < t1:
            parts.append(np.stack([a + t0 * d, a + t1 * d]))
    return parts
