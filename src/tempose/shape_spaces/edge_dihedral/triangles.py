"""Triangles laid out in the plane from the lengths of their sides."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.typing import FloatArray


@numba.njit(cache=True, nogil=True)
def _angle(a: float, b: float, c: float) -> float:
    """Angle between sides a and b, opposite to c (W. Kahan): exact in slivers, 0 or pi where none closes."""
    if a < b:
        a, b = b, a
    low = c - (a - b) if b >= c else b - (a - c)
    top = max((a - b) + c, 0.0) * max(low, 0.0)
    bottom = (a + (b + c)) * max((a - c) + b, 0.0)
    return 2.0 * math.atan2(math.sqrt(top), math.sqrt(bottom))


@numba.njit(cache=True, nogil=True)
def _lay_out(sides: Any, directions: Any, apex: Any) -> None:
    for f in range(len(sides)):
        l0, l1, l2 = sides[f, 0], sides[f, 1], sides[f, 2]
        first = _angle(l0, l2, l1)
        directions[f, 1] = math.pi - _angle(l0, l1, l2)
        directions[f, 2] = math.pi + first
        apex[f, 0] = l2 * math.cos(first)
        apex[f, 1] = l2 * math.sin(first)


def lay_out(sides: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lay triangles out: corner 0 at the origin, corner 1 on the positive first axis, corner 2 above it.

    Parameters
    ----------
    sides : (m, 3) float
        Lengths of the sides from corner k to corner k + 1. Where they close no triangle, a flat one is
        laid out with the first and the last side right.

    Returns
    -------
    directions : (m, 3) ndarray
        Angle of each side to the first axis, radians.
    apex : (m, 2) ndarray
        Where corner 2 lies.
    """
    sides = np.ascontiguousarray(sides, dtype=np.float64)
    directions, apex = np.zeros(sides.shape), np.zeros((len(sides), 2))
    _lay_out(sides, directions, apex)
    return directions, apex


def areas_from_lengths(sides: FloatArray) -> FloatArray:
    """Area of triangles from their sides.

    Parameters
    ----------
    sides : (m, 3) float
        Lengths.

    Returns
    -------
    (m,) ndarray
        Areas, 0 where no triangle closes.
    """
    return 0.5 * sides[:, 0] * lay_out(sides)[1][:, 1]
