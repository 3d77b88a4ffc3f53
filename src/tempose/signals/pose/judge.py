"""How good a layout of frames is: what the signals through all of its frames do between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.curves import Spline
from tempose.signals.pose.crossings import find_crossings
from tempose.signals.pose.fit import interpolating_pose_signal
from tempose.signals.pose.middles import curve_through, with_middles
from tempose.signals.pose.transitions import Transitions, find_bad_transitions
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Judgement:
    """A layout and its transitions."""

    name: str
    """How it was made."""
    positions: FloatArray
    """(n, 2) places of the frames."""
    transitions: Transitions
    """Of the signals that interpolate every frame."""
    aspect: float
    """Smaller over larger spread: near 0 the layout is a line along time, and says nothing."""
    crossings: int
    """How often the way from frame to frame crosses itself."""
    stress: float
    """How far distances in the plane are from those of the poses, as in `LayoutResult`."""

    @property
    def bad(self) -> int:
        """Number of bad transitions."""
        return int(self.transitions.bad.sum())


def judge_layout(
    name: str, P: FloatArray, X: FloatArray, stress: float, path: Spline, middles: FloatArray | None = None
) -> Judgement:
    """Judge a layout.

    Parameters
    ----------
    name : str
        How it was made.
    P : (n, 2) float
        Places of the frames.
    X : (n, m) float
        Their shape coordinates.
    stress : float
        Its stress.
    path : Spline
        The smooth motion through `X`.
    middles : (e,) float, optional
        Ticks where the pose signal is fitted to the path as well.

    Returns
    -------
    Judgement
        With the transitions of the interpolating signals.
    """
    samples = with_middles(P, X, np.zeros(0) if middles is None else middles, path)
    pose = interpolating_pose_signal(*samples)
    transitions = find_bad_transitions(pose, curve_through(P), X, path=path)
    return Judgement(name, P, transitions, aspect_ratio(P), len(find_crossings(P)), stress)


def aspect_ratio(P: FloatArray) -> float:
    """Return the smaller over the larger spread of places.

    Parameters
    ----------
    P : (n, 2) float
        Places.

    Returns
    -------
    float
        1 for a disc, 0 for a line or a point.
    """
    spread = np.linalg.svd(P - P.mean(axis=0), compute_uv=False)
    return float(spread[1] / spread[0]) if len(spread) > 1 and spread[0] > 0 else 0.0
