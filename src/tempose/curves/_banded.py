"""Least squares of a cubic B-spline by Givens rotations: rows of four neighbours, no normal equations."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.curves._kernels import basis, span_of
from tempose.typing import FloatArray


@njit(cache=True)
def rotate_rows(knots: FloatArray, u: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the triangular factor of the collocation matrix and the right-hand side that goes with it.

    Parameters
    ----------
    knots : (k + 4,) float
        Knots.
    u : (n,) float
        Ascending parameters.
    points : (n, c) float
        Right-hand sides.

    Returns
    -------
    tuple of (k, 4) and (k, c) ndarray
        Row j of the factor starts at column j.
    """
    k, c = len(knots) - 4, points.shape[1]
    R, Y = np.zeros((k, 4)), np.zeros((k, c))
    for n in range(len(u)):
        x = min(max(u[n], knots[3]), knots[k])
        j = span_of(knots, x) - 3
        row, right = basis(knots, j + 3, x, 3), points[n].copy()
        for column in range(4):
            _rotate(R[j + column], Y[j + column], row[column:], right)
    return R, Y


@njit(cache=True)
def _rotate(pivot: FloatArray, above: FloatArray, row: FloatArray, right: FloatArray) -> None:
    if row[0] == 0.0:
        return
    size = np.hypot(pivot[0], row[0])
    cos, sin = pivot[0] / size, row[0] / size
    for i in range(len(row)):
        pivot[i], row[i] = cos * pivot[i] + sin * row[i], cos * row[i] - sin * pivot[i]
    for d in range(len(right)):
        above[d], right[d] = cos * above[d] + sin * right[d], cos * right[d] - sin * above[d]


@njit(cache=True)
def back_substitute(R: FloatArray, Y: FloatArray) -> FloatArray:
    """Solve the banded triangular system.

    Parameters
    ----------
    R : (k, 4) float
        Row j starts at column j; no first entry may be 0.
    Y : (k, c) float
        Right-hand sides.

    Returns
    -------
    (k, c) ndarray
        Solution.
    """
    out = Y.copy()
    for j in range(len(R) - 1, -1, -1):
        for i in range(1, min(4, len(R) - j)):
            for d in range(out.shape[1]):
                out[j, d] -= R[j, i] * out[j + i, d]
        for d in range(out.shape[1]):
            out[j, d] /= R[j, 0]
    return out
