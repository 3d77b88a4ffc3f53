"""The pose signal of least squares on given sites (section 3.2 of the paper)."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import lstsq, lu_factor, lu_solve

from tempose._validate import as_floats
from tempose.signals.pose.basis import SiteBasis, best_anchors, plane_of
from tempose.signals.pose.merging import merge_places
from tempose.signals.pose.signal import PoseSignal
from tempose.typing import FloatArray


def fit_pose_signal(
    P: FloatArray, X: FloatArray, sites: FloatArray, weights: FloatArray | None = None
) -> PoseSignal:
    """Return the thin-plate spline of least squared error, eq. (4) of the paper, on given sites.

    Parameters
    ----------
    P : (n, 2) float
        Places in the pose plane.
    X : (n, m) float
        Shape coordinates there.
    sites : (l, 2) float
        Centres of the radial functions, l <= n; sites that coincide count as one.
    weights : (n,) float, optional
        How much the squared error of each place counts, positive; 1 if left out.

    Returns
    -------
    PoseSignal
        With `sites` = `P` and all different it passes through every row of `X`.

    Raises
    ------
    ValueError
        If shapes disagree, values are not finite, there are no sites, or more sites than places.
    """
    P = as_floats(P, "P", ("n", 2))
    X = as_floats(X, "X", (len(P), "m"))
    sites = as_floats(sites, "sites", ("l", 2))
    if not 1 <= len(sites) <= len(P):
        raise ValueError(f"sites must number 1 to {len(P)} (the places given), got {len(sites)}")
    w = np.ones(len(P)) if weights is None else as_floats(weights, "weights", (len(P),))
    if (w <= 0).any():
        raise ValueError(f"weights must be positive, got {w.min():.3g}")
    plane = plane_of(sites if len(np.unique(sites, axis=0)) > 1 else P)
    s = plane(sites)
    if len(plane.axes) + 1 > len(s):
        plane, s = plane_of(sites), plane_of(sites)(sites)
    anchors = best_anchors(plane, s)
    others = np.delete(s, anchors, axis=0)
    others = others[~(others[:, None] == s[anchors][None]).all(axis=2).any(axis=1)]
    basis = SiteBasis(plane, s[anchors], np.unique(others, axis=0))
    root = np.sqrt(w)[:, None]
    columns = root * basis.columns(plane(P))
    coefficients = _solve(columns, root * X)
    coefficients += _solve(columns, root * X - columns @ coefficients)
    return basis.signal(coefficients)


def interpolating_pose_signal(P: FloatArray, X: FloatArray) -> PoseSignal:
    """Return the thin-plate spline through all places: l = n of the paper.

    Parameters
    ----------
    P : (n, 2) float
        Places in the pose plane; frames at one place are averaged.
    X : (n, m) float
        Shape coordinates there.

    Returns
    -------
    PoseSignal
        What `order_sites` gives for all sites, by one square system.
    """
    places = merge_places(P, X)
    plane = plane_of(places.positions)
    q = plane(places.positions)
    anchors = best_anchors(plane, q)
    order = np.concatenate([anchors, np.delete(np.arange(len(q)), anchors)])
    basis = SiteBasis(plane, q[anchors], q[order[len(anchors) :]])
    factor = lu_factor(basis.columns(q[order]), check_finite=False)
    return basis.signal(lu_solve(factor, places.values[order], check_finite=False))


def _solve(A: FloatArray, B: FloatArray) -> FloatArray:
    found: Any = lstsq(A, B, lapack_driver="gelsy", cond=1e-14)
    return found[0]
