"""Samples between frames, for a pose signal that strays there."""

from __future__ import annotations

import numpy as np

from tempose.curves import Spline
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.time.path import time_path
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray, IntArray

QUARTERS: FloatArray = np.array([0.25, 0.5, 0.75])
"""Where between two frames the pose signal is held against the motion."""


def middles_of(transitions: IntArray) -> FloatArray:
    """Return the ticks at the quarters of transitions.

    Parameters
    ----------
    transitions : (b,) int
        From frame i to i + 1.

    Returns
    -------
    (3 b,) ndarray
        Ticks.
    """
    return np.ravel(transitions[:, None] + QUARTERS)


def with_middles(
    P: FloatArray, X: FloatArray, middles: FloatArray, path: Spline | None = None
) -> tuple[FloatArray, FloatArray]:
    """Add samples of the smooth motion to what a pose signal is fitted to.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames.
    X : (n, m) float
        Their shape coordinates.
    middles : (e,) float
        Ticks between the frames.
    path : Spline, optional
        The smooth motion through `X`; the natural cubic spline if left out.

    Returns
    -------
    P : (n + e, 2) ndarray
        Places of the frames, then of the middles, on the curve through all frames.
    X : (n + e, m) ndarray
        Shape coordinates of the frames, then of the smooth motion at the middles.
    """
    if len(middles) == 0:
        return P, X
    path = time_path(X) if path is None else path
    return np.concatenate([P, curve_through(P)(middles)]), np.concatenate([X, path(middles)])


def curve_through(P: FloatArray) -> TimeSignal:
    """Return the time signal through all places: k = n + 2 of the paper.

    Parameters
    ----------
    P : (n, 2) float
        Places of frames, n >= 2.

    Returns
    -------
    TimeSignal
        Ticks to places: a natural cubic spline over centripetal parameters, with a monotone pace.
    """
    return fit_time_signal(P, len(P) + 2)
