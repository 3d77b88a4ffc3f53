"""Lengths, normals and angles, compiled, by index of the vertices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.typing import FloatArray


@njit(cache=True, error_model="numpy")
def edge_length(V: FloatArray, i: Any, j: Any) -> float:
    """Distance between two vertices.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    i, j : int
        Their indices.

    Returns
    -------
    float
        Metres.
    """
    x, y, z = V[i, 0] - V[j, 0], V[i, 1] - V[j, 1], V[i, 2] - V[j, 2]
    return np.sqrt(x * x + y * y + z * z)


@njit(cache=True, error_model="numpy")
def normal(V: FloatArray, i: Any, j: Any, k: Any, out: FloatArray) -> float:
    """Find the unit normal of a triangle.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    i, j, k : int
        Corners, counter-clockwise.
    out : (3,) float
        Receives the normal.

    Returns
    -------
    float
        Twice the area, square metres.
    """
    ax, ay, az = V[j, 0] - V[i, 0], V[j, 1] - V[i, 1], V[j, 2] - V[i, 2]
    bx, by, bz = V[k, 0] - V[i, 0], V[k, 1] - V[i, 1], V[k, 2] - V[i, 2]
    out[0], out[1], out[2] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    length = np.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    out /= max(length, 1e-30)
    return length


@njit(cache=True, error_model="numpy")
def cotangent(V: FloatArray, i: Any, apex: Any, j: Any) -> float:
    """Cotangent of the angle of a triangle.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    i, apex, j : int
        Corners; the angle is that at the second.

    Returns
    -------
    float
        Its cotangent.
    """
    dot, cross = 0.0, np.zeros(3)
    for c in range(3):
        dot += (V[i, c] - V[apex, c]) * (V[j, c] - V[apex, c])
    return dot / max(normal(V, apex, i, j, cross), 1e-30)
