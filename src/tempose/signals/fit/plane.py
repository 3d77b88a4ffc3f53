"""Pose and time signal of a clip whose shape coordinates are known (sections 3.2 and 3.3 of the paper)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tempose.signals.fit.fidelity import POSE_SHARE, choose_controls, choose_sites
from tempose.signals.fit.notes import Notes
from tempose.signals.fit.options import FitOptions
from tempose.signals.pose import (
    PoseLayout,
    PoseSignal,
    choose_layout,
    densified_order,
    fit_pose_signal,
    order_sites,
)
from tempose.signals.pose.choose import pose_distances
from tempose.signals.pose.middles import with_middles
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.time.signal import TimeSignal
from tempose.signals.windows import WindowedPose, fit_dense_windows, fit_windows
from tempose.typing import FloatArray, IntArray

POOR_STRESS = 0.35
"""Stress above which distances in the plane say little about those between poses."""

FAR = 1e4
"""How many times as far apart as the poses pins may lie."""

ASTRAY = 0.3
"""Part of the layout's radius by which a curve may miss the frames before a warning is due."""


@dataclass(frozen=True, eq=False)
class Goal:
    """What the pose and the time signal may leave out, as squared sums over all frames."""

    base: float
    """What the shape signal has left out already."""
    total: float
    """What all three may leave out together; infinite where nothing was asked for."""


@dataclass(frozen=True, eq=False)
class Plane:
    """The frames in the pose plane and g through them."""

    positions: FloatArray
    """(T, 2) places of the frames."""
    pose: PoseSignal | WindowedPose
    """g."""
    site_frames: IntArray
    """(l,) frames that are sites; none for windows."""
    left_out: FloatArray
    """(T,) squared residual of g at the places of the frames."""
    middles: FloatArray
    """(e,) ticks between frames that g was fitted to as well."""


def fit_plane(
    X: FloatArray, options: FitOptions, pins: Mapping[int, FloatArray], goal: Goal, notes: Notes
) -> Plane:
    """Lay the frames out and fit the pose signal to them.

    Parameters
    ----------
    X : (T, m) float
        Orthonormal shape coordinates.
    options : FitOptions
        Number of sites, kind of layout, length of windows.
    pins : mapping of int to (2,) float
        Frames kept at places.
    goal : Goal
        What may be left out.
    notes : Notes
        Gets seconds, facts and warnings.

    Returns
    -------
    Plane
        Places and g.
    """
    if len(X) > options.window:
        return _windowed(X, options, pins, goal, notes)
    with notes.stage("layout"):
        P, middles = _laid_out(X, options, pins, notes)
    with notes.stage("pose"):
        order = order_sites(*with_middles(P, X, middles), most=options.l)
        l = options.l
        if l is None:
            l = choose_sites(order.errors, goal.base, POSE_SHARE**2 * goal.total)
        pose = order.signal(max(l, order.least))
        if order.floor > 0:
            notes.facts["floor"] = order.floor
    chosen = order.order[: len(pose.sites)]
    return Plane(P, pose, chosen[chosen < len(X)], np.square(pose(P) - X).sum(axis=1), middles)


def _laid_out(
    X: FloatArray, options: FitOptions, pins: Mapping[int, FloatArray], notes: Notes
) -> tuple[FloatArray, FloatArray]:
    """Return places of the frames, and ticks between them that g needs samples at: only where l is free."""
    _check_reach(X, pins)
    if options.layout == "mds":
        result = PoseLayout(pose_distances(X)).solve(pins)
        _note_layout(notes, "mds", result.stress, result.warnings)
        return result.positions, np.zeros(0)
    choice = choose_layout(X, pins)
    middles = choice.middles if options.l is None else np.zeros(0)
    name = choice.name if len(middles) else choice.name.removesuffix(" + middles")
    strays = [w for w in choice.warnings if "stray" not in w]  # measured on the final signals instead
    _note_layout(notes, name, choice.stress, tuple(strays))
    notes.facts["layout"] |= {"aspect": choice.aspect, "crossings": choice.crossings}
    return choice.positions, middles


def _check_reach(X: FloatArray, pins: Mapping[int, FloatArray]) -> None:
    if len(pins) < 2:
        return
    places = np.array(list(pins.values()))
    wide, poses = float(np.ptp(places, axis=0).max()), float(np.ptp(X, axis=0).max())
    if wide > FAR * poses:
        raise ValueError(
            f"pins lie {wide:.3g} apart, but the poses only {poses:.3g}: places are in units of the pose "
            "plane, in which distances are those between poses"
        )


def _note_layout(notes: Notes, name: str, stress: float, warnings: tuple[str, ...]) -> None:
    notes.facts["layout"] = {"name": name, "stress": stress}
    notes.warnings.extend(warnings)
    # other layouts follow distances along the motion and mean to miss those between poses
    if stress > POOR_STRESS and name in ("mds", "key frames"):
        notes.warnings.append(
            f"doubtful layout: distances in the pose plane miss those between poses by {100 * stress:.0f} %"
        )


def _windowed(
    X: FloatArray, options: FitOptions, pins: Mapping[int, FloatArray], goal: Goal, notes: Notes
) -> Plane:
    allowed = max((POSE_SHARE**2 * goal.total - goal.base) / len(X), 1e-300)
    with notes.stage("pose"):
        fit = fit_windows(
            X, options.window, sites=options.l, limit=allowed, pins=pins, progress=notes.progress
        )
    _note_layout(notes, "key frames", fit.layout.stress, fit.layout.warnings)
    notes.facts["windows"] = len(fit.pose.windows)
    return Plane(fit.positions, fit.pose, np.zeros(0, np.int64), fit.errors, np.zeros(0))


def fit_time(
    plane: Plane, X: FloatArray, options: FitOptions, goal: Goal, notes: Notes
) -> tuple[TimeSignal, PoseSignal | WindowedPose]:
    """Fit the time signal, then the pose signal once more where the curve runs.

    Parameters
    ----------
    plane : Plane
        Places and g.
    X : (T, m) float
        Orthonormal shape coordinates.
    options : FitOptions
        Number of controls, and whether g follows the motion between frames.
    goal : Goal
        What may be left out.
    notes : Notes
        Gets seconds, facts and warnings.

    Returns
    -------
    time : TimeSignal
        f.
    pose : PoseSignal or WindowedPose
        g.

    Notes
    -----
    k is chosen with g as it was: fitted anew for every k, g would learn time along a curve that is nowhere
    near the poses, and six controls would do for any clip.
    """
    ticks = np.arange(float(len(X)))

    def error(k: int) -> float:
        f = fit_time_signal(plane.positions, k)
        return goal.base + float(np.square(plane.pose(f(ticks), ticks) - X).sum())

    with notes.stage("time"):
        k = options.k
        if k is None:
            k, _ = choose_controls(error, len(X), goal.total, notes.progress)
        f = fit_time_signal(plane.positions, k)
        pose = _dense(plane, f, X, options) if options.between == "dense" else _refitted(plane, f, X)
    miss = float(np.sqrt(np.square(f(ticks) - plane.positions).sum(axis=1).mean()))
    radius = float(np.sqrt(np.square(plane.positions - plane.positions.mean(axis=0)).sum(axis=1).mean()))
    if miss > ASTRAY * radius:
        notes.warnings.append(
            f"collapsed curve: with k = {k} controls it misses the frames by {100 * miss / radius:.0f} % of "
            "the layout's radius; take more controls"
        )
    return f, pose


def _refitted(plane: Plane, f: TimeSignal, X: FloatArray) -> PoseSignal | WindowedPose:
    """Fit g to the poses where the curve is, sites unchanged, if that is nearer to the frames."""
    pose, ticks = plane.pose, np.arange(float(len(X)))
    if isinstance(pose, WindowedPose) or len(plane.middles) or len(pose.sites) > len(X):
        return pose
    on_curve = f(ticks)
    if np.array_equal(on_curve, plane.positions):
        return pose
    again = fit_pose_signal(on_curve, X, pose.sites)
    better = np.square(again(on_curve) - X).sum() < np.square(pose(on_curve) - X).sum()
    return again if better else pose


def _dense(plane: Plane, f: TimeSignal, X: FloatArray, options: FitOptions) -> PoseSignal | WindowedPose:
    if isinstance(plane.pose, WindowedPose):
        return fit_dense_windows(f, X, plane.pose.cover, options.l)
    return densified_order(f(np.arange(float(len(X)))), X, f, most=options.l).signal()


def turned(pose: PoseSignal | WindowedPose, turn: FloatArray | None) -> PoseSignal | WindowedPose:
    """Take a pose signal from an orthonormal basis to the shape coordinates.

    Parameters
    ----------
    pose : PoseSignal or WindowedPose
        g in coordinates ``x L``.
    turn : (m, m) float or None
        L; None changes nothing.

    Returns
    -------
    PoseSignal or WindowedPose
        g in coordinates x.
    """
    if turn is None:
        return pose
    if isinstance(pose, WindowedPose):
        return replace(pose, windows=tuple(_turned(g, turn) for g in pose.windows))
    return _turned(pose, turn)


def _turned(pose: PoseSignal, turn: FloatArray) -> PoseSignal:
    back = np.linalg.inv(turn)
    return PoseSignal(pose.sites, pose.weights @ back, pose.affine @ back, pose.centre, pose.radius)
