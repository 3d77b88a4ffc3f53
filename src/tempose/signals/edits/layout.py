"""Edits of the layout: what is played keeps its poses, the pose plane is laid out anew."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tempose._validate import as_floats
from tempose.curves import Spline, interpolating_spline, monotone_map
from tempose.curves.refine import insert_knots
from tempose.signals.edits._frames import frame_seconds
from tempose.signals.pose.choose import choose_layout, pose_distances
from tempose.signals.pose.layout import PoseLayout, congruence
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.pose.sites import order_sites
from tempose.signals.pose.transitions import find_bad_transitions
from tempose.signals.shape.examples import orthonormal_basis
from tempose.signals.signals import Signals
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray

FINER = 8
"""Samples a tick at which edits of the curve become part of the path."""


def pin_frames(signals: Signals, pins: Mapping[float, Sequence[float] | FloatArray]) -> Signals:
    """Give frames their places in the pose plane and lay the others out round them.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    pins : mapping of float to (2,) float
        Frame from 0, of what is played, to its place.

    Returns
    -------
    Signals
        Whose curve runs through the places at those frames; sites and controls are as many as before, and
        places near where they were. With a path every frame shows what it did.

    Raises
    ------
    ValueError
        If there is no such frame, frames of different poses share a place, or the clip was laid out in
        windows.
    """
    at = {float(signals.ticks(np.array(frame_seconds(signals, q, "frame")))): p for q, p in pins.items()}
    ticks = _grid(signals)
    for tick in at:
        ticks[int(np.abs(ticks - tick).argmin())] = tick
    ticks = np.unique(ticks)
    places = {int(np.searchsorted(ticks, t)): as_floats(p, "at", (2,)) for t, p in at.items()}
    _, turned = _poses_at(signals, ticks)
    near = PoseLayout(pose_distances(turned)).solve(places, signals.time(ticks)).positions
    return _laid_out(signals, ticks, near, _pose_signal(signals, near, turned), places)


def repair_transitions(signals: Signals) -> Signals:
    """Lay out what is played so that the way from frame to frame is good.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.

    Returns
    -------
    Signals
        With as many sites and controls as before, or more sites where a transition needs its own; `signals`
        itself if no transition was bad. Edits of the curve have become part of what is played.

    Raises
    ------
    ValueError
        If the clip was laid out in windows.
    """
    ticks = _grid(signals)
    X, turned = _poses_at(signals, ticks)
    if not _bad(signals, X, ticks):
        return signals
    choice = choose_layout(turned)
    places, samples = choice.samples(turned)
    to_old = congruence(choice.positions, signals.time(ticks))
    pose = _pose_signal(signals, to_old(places), samples, extra=len(choice.middles))
    result = _laid_out(signals, ticks, to_old(choice.positions), pose, {})
    return min((signals, result), key=lambda s: _bad(s, X, ticks))


def _grid(signals: Signals) -> FloatArray:
    if not isinstance(signals.pose, PoseSignal):
        raise ValueError(
            "the clip was laid out in windows, each a plane of its own; fit it with a larger window"
        )
    first, last = signals.time.pace.domain
    return np.linspace(first, last, max(round(last - first), 1) + 1)


def _poses_at(signals: Signals, ticks: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return shape coordinates at ticks, edits included, and turned so that distances are those of shapes."""
    X = signals.coordinates_at(ticks)
    return X, X @ orthonormal_basis(signals.shape)


def _laid_out(
    signals: Signals,
    ticks: FloatArray,
    P: FloatArray,
    pose: PoseSignal,
    pins: Mapping[int, FloatArray],
) -> Signals:
    k = int(np.clip(len(signals.time.curve.controls), 4, len(P) + 2))
    fitted = fit_time_signal(P, k)
    parameters = fitted.pace.values
    curve = _through(fitted.curve, parameters[list(pins)], np.array([*pins.values()]).reshape(-1, 2))
    time = TimeSignal(curve, curve, monotone_map(ticks, parameters))
    return replace(signals, pose=pose, time=time, path=_played_path(signals), fade_step=None)


def _pose_signal(signals: Signals, P: FloatArray, turned: FloatArray, extra: int = 0) -> PoseSignal:
    l = min(len(signals.pose.sites) + extra, len(P))
    order = order_sites(P, turned)
    fitted = order.signal(max(l, order.least))
    back = np.linalg.inv(orthonormal_basis(signals.shape))
    return replace(fitted, weights=fitted.weights @ back, affine=fitted.affine @ back)


def _through(curve: Spline, u: FloatArray, places: FloatArray) -> Spline:
    # the least change of the controls that takes the curve through the pinned places
    if len(u) == 0:
        return curve
    k = len(curve.controls)
    B = Spline(curve.knots, np.eye(k))(u)
    change = np.linalg.lstsq(B, places - curve(u), rcond=None)[0]
    return Spline(curve.knots, curve.controls + change)


def _played_path(signals: Signals) -> Spline | None:
    """Return the path with the edits of the curve in it: the new layout knows nothing of them."""
    path, time = signals.path, signals.time
    if path is None or np.array_equal(time.curve.controls, time.unedited.controls):
        return path
    knots = np.unique(path.knots)
    shares = np.arange(1, FINER)[:, None] / FINER
    fine = insert_knots(path, np.ravel(knots[:-1] + shares * np.diff(knots)))
    u = np.unique(fine.knots)
    played = signals.coordinates_at(u)
    if len(u) + 2 != len(fine.controls):
        return interpolating_spline(u, played)
    return Spline(fine.knots, fine.controls + interpolating_spline(u, played - path(u)).controls)


def _bad(signals: Signals, X: FloatArray, grid: FloatArray) -> int:
    def place_of(ticks: FloatArray) -> FloatArray:
        return signals.time(np.interp(ticks, np.arange(len(grid)), grid))

    return int(find_bad_transitions(signals.pose, place_of, X).bad.sum())
