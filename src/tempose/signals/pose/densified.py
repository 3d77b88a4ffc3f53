"""A pose signal that follows the smooth motion between frames too."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.curves import Spline
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.pose.sites import SiteOrder, order_sites
from tempose.signals.pose.transitions import PlaceMap
from tempose.signals.time.path import time_path
from tempose.typing import FloatArray

FRAME_WEIGHT = 900.0
"""How much more the squared error at a frame counts than that between frames."""


def densified_order(
    P: FloatArray,
    X: FloatArray,
    time: PlaceMap,
    *,
    times: int = 4,
    most: int | None = None,
    path: Spline | None = None,
) -> SiteOrder:
    """Choose sites among the frames and places between them.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames.
    X : (n, m) float
        Their shape coordinates.
    time : callable
        The time signal f, over frames from 0.
    times : int, default 4
        Samples from one frame to the next.
    most : int, optional
        Sites at most; 3 n if left out.
    path : Spline, optional
        Shape coordinates over frames; the natural cubic spline through `X` if left out.

    Returns
    -------
    SiteOrder
        Over ``times (n - 1) + 1`` samples in order of time; sample ``times i`` is frame i.
    """
    P = as_floats(P, "P", ("n", 2))
    X = as_floats(X, "X", (len(P), "m"))
    n = len(P)
    if n < 2:
        return order_sites(P, X)
    if times < 1:
        raise ValueError(f"times must be 1 or more, got {times}")
    path = time_path(X) if path is None else path
    ticks = np.arange(times * (n - 1) + 1) / times
    places, values = time(ticks), path(ticks)
    places[::times], values[::times] = P, X
    weights = np.ones(len(ticks))
    weights[::times] = FRAME_WEIGHT
    return order_sites(places, values, weights, 3 * n if most is None else most)


def densified_pose_signal(
    P: FloatArray,
    X: FloatArray,
    time: PlaceMap,
    l: int | None = None,
    *,
    times: int = 4,
    path: Spline | None = None,
) -> PoseSignal:
    """Fit the pose signal to the frames and to the smooth motion between them.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames.
    X : (n, m) float
        Their shape coordinates.
    time : callable
        The time signal f, over frames from 0.
    l : int, optional
        Sites; 3 n if left out. Fewer than 2 n lose the frames to what is between them.
    times : int, default 4
        Samples from one frame to the next.
    path : Spline, optional
        Shape coordinates over frames; the natural cubic spline through `X` if left out.

    Returns
    -------
    PoseSignal
        ``g(f(t))`` follows the path between frames, where the pose signal of the paper can stray by many
        steps (see `find_bad_transitions`).
    """
    return densified_order(P, X, time, times=times, most=l, path=path).signal()
