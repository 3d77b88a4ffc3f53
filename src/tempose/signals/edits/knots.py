"""Where a new knot of a curve may go."""

from __future__ import annotations

import numpy as np

from tempose.curves import Spline


def free_place(spline: Spline, u: float) -> float:
    """Return the place nearest to a wanted one that leaves knots apart.

    Parameters
    ----------
    spline : Spline
        A curve.
    u : float
        Where a knot is wanted.

    Returns
    -------
    float
        `u`, or where the middle half of its span begins or ends: knots that coincide would let the curve
        lose its curvature's continuity as soon as a control there moves.
    """
    knots = np.unique(spline.knots)
    i = int(np.clip(np.searchsorted(knots, u, side="right") - 1, 0, len(knots) - 2))
    quarter = 0.25 * (knots[i + 1] - knots[i])
    return float(np.clip(u, knots[i] + quarter, knots[i + 1] - quarter))
