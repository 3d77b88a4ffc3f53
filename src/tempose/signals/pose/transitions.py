"""Transitions between frames that the pose signal gets wrong."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.curves import Spline
from tempose.signals.time.path import time_path
from tempose.typing import BoolArray, FloatArray

LIMIT = 0.5
"""Steps between frames that a transition may stray from the smooth motion through them."""

STILL = 0.1
"""Steps smaller than this part of the mean one are measured as if they were that large."""


class PoseMap(Protocol):
    """A pose signal: anything that gives shape coordinates at places of the pose plane."""

    def __call__(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Return the shape coordinates at places.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            Ticks of the captured clip that they come from.
        """
        ...


class PlaceMap(Protocol):
    """A time signal: anything that gives places of the pose plane at ticks."""

    def __call__(self, ticks: FloatArray) -> FloatArray:
        """Return the places at ticks.

        Parameters
        ----------
        ticks : (...) float
            Times in frames of the captured clip.
        """
        ...


@dataclass(frozen=True, eq=False)
class Transitions:
    """How far the pose signal strays between frames."""

    deviation: FloatArray
    """(n - 1,) distance of ``g(f)`` from the time spline half way between frames i and i + 1, beyond that at
    the frames themselves, in steps ``|x_{i+1} - x_i|``."""
    limit: float
    """Deviation above which a transition is bad."""

    @property
    def bad(self) -> BoolArray:
        """(n - 1,) which transitions are bad."""
        return self.deviation > self.limit

    @property
    def worst(self) -> float:
        """Largest deviation, in steps; 0 without transitions."""
        return float(self.deviation.max(initial=0.0))


def find_bad_transitions(
    pose: PoseMap, time: PlaceMap, X: FloatArray, *, path: Spline | None = None, limit: float = LIMIT
) -> Transitions:
    """Measure every transition between neighbouring frames at its middle.

    Parameters
    ----------
    pose : callable
        The pose signal g.
    time : callable
        The time signal f, over frames from 0.
    X : (n, m) float
        Shape coordinates of the frames.
    path : Spline, optional
        The smooth motion to compare with; the natural cubic spline through `X` if left out.
    limit : float, default 0.5
        Steps above which a transition counts as bad.

    Returns
    -------
    Transitions
        Deviation of every interval.

    Notes
    -----
    Frames are reproduced whatever happens between them, so nothing at the frames shows a bad transition
    (figure 3 of [1]_). Nor does negative Gaussian curvature of g, which [1]_ suggests in its section 6: on
    measured clips it is there in half of all good transitions and missing in most bad ones.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31, 2012.
    """
    X = as_floats(X, "X", ("n", "m"))
    if len(X) < 2:
        return Transitions(np.zeros(0), limit)
    path = time_path(X) if path is None else path
    middles = np.arange(len(X) - 1) + 0.5
    frames = np.arange(len(X), dtype=np.float64)
    stray = np.linalg.norm(pose(time(middles), middles) - path(middles), axis=1)
    # a coarse fit is off at the frames too: that is its error, not what happens between them
    off = np.linalg.norm(pose(time(frames), frames) - path(frames), axis=1)
    stray = np.maximum(stray - np.maximum(off[1:], off[:-1]), 0.0)
    return Transitions(read_only(stray / step_sizes(X)), limit)


def step_sizes(X: FloatArray) -> FloatArray:
    """Return the distances between neighbouring frames, none of them nearly zero.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames.

    Returns
    -------
    (n - 1,) ndarray
        At least `STILL` of their mean; 1 if all are zero.
    """
    steps = np.linalg.norm(np.diff(X, axis=0), axis=1)
    # not the median: of a clip that holds every frame twice that would be the noise
    return np.maximum(steps, STILL * float(steps.mean())) if steps.any() else np.ones(len(steps))
