"""Cubic splines near points: least squares over given knots."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.curves._banded import back_substitute, rotate_rows
from tempose.curves.spline import Spline
from tempose.typing import FloatArray


def least_squares_spline(knots: FloatArray, u: FloatArray, points: FloatArray) -> Spline:
    """Return the spline over knots that comes nearest to points.

    Parameters
    ----------
    knots : (k + 4,) float
        Knots, the ends fourfold.
    u : (n,) float
        Ascending parameters, n >= k.
    points : (n, c) float
        Where the curve should be at those parameters.

    Returns
    -------
    Spline
        With the least sum of squared distances.

    Raises
    ------
    ValueError
        If the points do not determine it: for every control there must be a parameter inside its support,
        for each another one (Schoenberg and Whitney).
    """
    u = as_floats(u, "u", ("n",))
    points = as_floats(points, "points", (len(u), "c"))
    knots = as_floats(knots, "knots", ("k + 4",))
    R, Y = rotate_rows(knots, u, points)
    if not determines(knots, u) or (np.abs(R[:, 0]) < 1e-12).any():
        raise ValueError(
            f"{len(u)} parameters do not determine {len(R)} controls over these knots: give fewer knots, or "
            "place them so that each control has a parameter of its own inside its support"
        )
    return Spline(knots, back_substitute(R, Y))


def determines(knots: FloatArray, u: FloatArray) -> bool:
    """Return whether parameters determine a spline over knots (Schoenberg and Whitney).

    Parameters
    ----------
    knots : (k + 4,) float
        Knots, the ends fourfold.
    u : (n,) float
        Ascending parameters.

    Returns
    -------
    bool
        Whether each control can be given a parameter of its own inside its support.
    """
    k, first, last = len(knots) - 4, knots[3], knots[-4]
    i = 0
    for j in range(k):
        # at the ends of the domain the first and the last B-spline are 1, the others 0
        while i < len(u) and not (u[i] > knots[j] or (j == 0 and u[i] >= first)):
            i += 1
        if i == len(u) or not (u[i] < knots[j + 4] or (j == k - 1 and u[i] <= last)):
            return False
        i += 1
    return True
