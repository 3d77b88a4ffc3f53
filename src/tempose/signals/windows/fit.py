"""Fitting a pose signal window by window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.signals.fit.fidelity import choose_sites
from tempose.signals.pose.densified import densified_order
from tempose.signals.pose.middles import curve_through, middles_of
from tempose.signals.pose.pins import Pins
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.pose.sites import order_sites
from tempose.signals.pose.transitions import find_bad_transitions
from tempose.signals.time.path import time_path
from tempose.signals.windows.cover import Cover, cover
from tempose.signals.windows.layout import KEYS, LongLayout, long_layout
from tempose.signals.windows.pose import WindowedPose
from tempose.typing import FloatArray, Progress, silent

WINDOW = 300
"""Frames of a window: the greedy order of sites costs their cube, and a surface has few folds for so many."""

ROUNDS = 5
"""How often transitions are judged; two or three times samples have to be added."""


@dataclass(frozen=True, eq=False)
class WindowedFit:
    """A long clip in the pose plane."""

    pose: WindowedPose
    """g."""
    layout: LongLayout
    """Where the frames lie."""
    errors: FloatArray
    """(T,) squared residual of g at each frame."""
    middles: FloatArray
    """(e,) ticks between frames to which g was fitted, too, since transitions there were bad."""

    @property
    def positions(self) -> FloatArray:
        """(T, 2) places of the frames."""
        return self.layout.positions


def fit_windows(
    X: FloatArray,
    window: int = WINDOW,
    overlap: int | None = None,
    *,
    sites: int | None = None,
    limit: float = 0.0,
    keys: int = KEYS,
    pins: Pins | None = None,
    progress: Progress = silent,
) -> WindowedFit:
    """Lay out a long clip and fit its pose signal, in time linear in the frames.

    Parameters
    ----------
    X : (T, m) float
        Shape coordinates of the frames.
    window : int, default 300
        Largest number of frames in a window.
    overlap : int, optional
        Frames that neighbouring windows share; a fifth of a window if left out.
    sites : int, optional
        Number of sites in each window; then g is fitted to frames alone. Left out, it is also fitted to the
        smooth motion between frames where it would stray from it.
    limit : float, default 0
        Where `sites` is left out: the largest mean squared residual of the frames of a window. 0 takes all.
    keys : int, default 300
        See `long_layout`; one window is laid out without.
    pins : mapping of int to (2,) float, optional
        Frames that the user keeps at places.
    progress : Progress, optional
        Told of each window.

    Returns
    -------
    WindowedFit
        Places and pose signal.

    Raises
    ------
    ValueError
        If window and overlap do not go together or `X` is not finite.
    """
    X = as_floats(X, "X", ("T", "m"))
    windows = cover(len(X), window, window // 5 if overlap is None else overlap)
    layout = long_layout(X, len(X) if len(windows) == 1 else keys, pins, progress)
    if sites is None:
        pose, middles = _without_bad_transitions(layout.positions, X, windows, limit, progress)
    else:
        middles = np.zeros(0)
        pose = fit_windowed_pose(layout.positions, X, windows, sites=sites, progress=progress)
    found = pose(layout.positions, np.arange(float(len(X))))
    return WindowedFit(pose, layout, np.square(found - X).sum(axis=1), middles)


def fit_windowed_pose(
    P: FloatArray,
    X: FloatArray,
    windows: Cover,
    *,
    sites: int | None = None,
    limit: float = 0.0,
    progress: Progress = silent,
) -> WindowedPose:
    """Fit a pose signal to each window of frames whose places are known.

    Parameters
    ----------
    P : (T, 2) float
        Places of the frames.
    X : (T, m) float
        Their shape coordinates.
    windows : Cover
        The windows.
    sites : int, optional
        Number of sites in each window.
    limit : float, default 0
        Where `sites` is left out: the largest mean squared residual of the frames of a window. 0 takes all.
    progress : Progress, optional
        Told of each window.

    Returns
    -------
    WindowedPose
        The pose signal.
    """
    signals: list[PoseSignal] = []
    for i in range(len(windows)):
        frames = windows.frames(i)
        n_frames = frames.stop - frames.start
        number = None if sites is None else min(sites, n_frames)
        signals.append(_fit_one(P[frames], X[frames], number, limit * n_frames))
        progress(i + 1, len(windows), "pose signal")
    return WindowedPose(tuple(signals), windows)


def fit_dense_windows(
    time: Callable[[FloatArray], FloatArray], X: FloatArray, windows: Cover, most: int | None = None
) -> WindowedPose:
    """Fit each window to the smooth motion at quarter frames, along a curve.

    Parameters
    ----------
    time : callable
        The time signal f: ticks to places.
    X : (T, m) float
        Shape coordinates of the frames.
    windows : Cover
        The windows.
    most : int, optional
        Sites of a window at most; three times its frames if left out.

    Returns
    -------
    WindowedPose
        The pose signal.
    """
    path = time_path(X, None)
    signals: list[PoseSignal] = []
    for i in range(len(windows)):
        frames = windows.frames(i)
        ticks = np.arange(frames.start, frames.stop, dtype=np.float64)

        def here(ticks: FloatArray, start: int = frames.start) -> FloatArray:
            return time(ticks + start)

        order = densified_order(time(ticks), X[frames], here, most=most, path=path.shifted(-frames.start))
        signals.append(order.signal())
    return WindowedPose(tuple(signals), windows)


def _fit_one(P: FloatArray, X: FloatArray, sites: int | None, allowed: float) -> PoseSignal:
    order = order_sites(P, X)
    number = choose_sites(order.errors, 0.0, allowed) if sites is None else sites
    return order.signal(max(number, order.least))


def _without_bad_transitions(
    P: FloatArray, X: FloatArray, windows: Cover, limit: float, progress: Progress
) -> tuple[WindowedPose, FloatArray]:
    """Fit windows; where g strays between frames, fit them anew to the smooth motion there as well."""
    pose = fit_windowed_pose(P, X, windows, limit=limit, progress=progress)
    if len(X) < 3:
        return pose, np.zeros(0)
    curve, path = curve_through(P), time_path(X, None)
    middles = np.zeros(0)
    best, best_middles, fewest = pose, middles, len(X)
    for _ in range(ROUNDS):
        bad = np.flatnonzero(find_bad_transitions(pose, curve, X, path=path).bad)
        if len(bad) < fewest:
            best, best_middles, fewest = pose, middles, len(bad)
        if len(bad) == 0:
            break
        fresh = np.setdiff1d(middles_of(bad), middles)
        middles = np.union1d(middles, fresh)
        signals = list(pose.windows)
        for i in range(len(windows)):
            if len(_inside(windows.frames(i), fresh)):
                frames, here = windows.frames(i), _inside(windows.frames(i), middles)
                places = np.concatenate([P[frames], curve(here)])
                values = np.concatenate([X[frames], path(here)])
                signals[i] = _fit_one(places, values, None, limit * (frames.stop - frames.start))
        pose = WindowedPose(tuple(signals), windows)
    return best, best_middles


def _inside(frames: slice, ticks: FloatArray) -> FloatArray:
    return ticks[(ticks > frames.start) & (ticks < frames.stop - 1)]
