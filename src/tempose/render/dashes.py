"""Lines cut into dashes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.typing import FloatArray


def dashed(
    points: FloatArray, values: FloatArray, dash: Sequence[float]
) -> list[tuple[FloatArray, FloatArray]]:
    """Cut a line into the pieces of it that are drawn.

    Parameters
    ----------
    points : (n, 2) float
        The line.
    values : (n, c) float
        What goes along with the points, such as colours; interpolated at the cuts.
    dash : sequence of float
        Lengths drawn and left out, in turns, in the unit of the points; none draws all.

    Returns
    -------
    list of (points, values)
        The pieces, in order.
    """
    points, values = np.asarray(points, dtype=np.float64), np.asarray(values, dtype=np.float64)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    moved = np.concatenate([[True], steps > 0])
    points, values = points[moved], values[moved]
    if not dash or len(points) < 2:
        return [(points, values)]
    along = np.concatenate([[0.0], np.cumsum(steps[steps > 0])])
    period = float(sum(dash[:2]))
    starts = np.arange(0.0, along[-1], period)
    return [_piece(points, values, along, a, min(a + dash[0], along[-1])) for a in starts]


def _piece(
    points: FloatArray, values: FloatArray, along: FloatArray, a: float, b: float
) -> tuple[FloatArray, FloatArray]:
    at = np.concatenate([[a], along[(along > a) & (along < b)], [b]])

    def cut(y: FloatArray) -> FloatArray:
        return np.column_stack([np.interp(at, along, column) for column in y.T])

    return cut(points), cut(values)
