"""The layout of a clip in the pose plane, chosen so that transitions between frames are good."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist, squareform

from tempose._validate import as_floats, read_only
from tempose.curves import Spline
from tempose.signals.pose.judge import Judgement, aspect_ratio, judge_layout
from tempose.signals.pose.layout import PoseLayout, stress_of
from tempose.signals.pose.middles import middles_of, with_middles
from tempose.signals.pose.pins import Pins, check_pins
from tempose.signals.pose.smoothing import main_columns, smooth_transitions
from tempose.signals.pose.time_graph import time_graph_distances
from tempose.signals.time.path import time_path
from tempose.typing import FloatArray, IntArray

REACHES = (4.0, 3.0, 2.5, 2.0)
"""Reaches of time graphs tried, in steps: see `time_graph_distances`."""

LEAST_ASPECT = 0.2
"""A layout flatter than this has become a line along time."""

CALM = 0.25
"""Transitions that stray by no more steps than this are left as they are."""

LONGEST = 400
"""Clips of more frames are laid out but not smoothed: a step takes the cube of the frames."""


@dataclass(frozen=True, eq=False)
class LayoutChoice:
    """The layout chosen, and what else was tried."""

    positions: FloatArray
    """(n, 2) places of the frames."""
    name: str
    """How it was made, such as ``"mds"`` or ``"mds, smoothed"``; and ``" + middles"`` if there are any."""
    bad: IntArray
    """(b,) transitions i, from frame i to i + 1, that are still bad."""
    aspect: float
    """Smaller over larger spread of the places."""
    crossings: int
    """How often the way from frame to frame crosses itself."""
    stress: float
    """How far distances in the plane are from those of the poses."""
    deviation: FloatArray
    """(n - 1,) how far every transition strays, in steps."""
    middles: FloatArray
    """(e,) ticks between frames where the pose signal needs samples of its own: see `samples`."""
    tried: tuple[Judgement, ...]
    """Every layout tried, in order."""
    warnings: tuple[str, ...] = ()
    """What remains wrong, with its measure."""

    def samples(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what the pose signal is to be fitted to.

        Parameters
        ----------
        X : (n, m) float
            Shape coordinates of the frames.

        Returns
        -------
        P : (n + e, 2) ndarray
            Places of the frames, then of the middles.
        X : (n + e, m) ndarray
            Shape coordinates of the frames, then of the smooth motion at the middles.
        """
        return with_middles(self.positions, X, self.middles)


def choose_layout(X: FloatArray, pins: Pins | None = None) -> LayoutChoice:
    """Lay out the frames of a clip without bad transitions.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames.
    pins : mapping of int to (2,) float, optional
        Frames kept at places of the pose plane.

    Returns
    -------
    LayoutChoice
        Plain scaling, smoothed unless its transitions are calm; else the first layout without bad ones.

    Raises
    ------
    ValueError
        If `X` is not finite or the pins contradict it.

    Notes
    -----
    Tried in turn, each as it is and then smoothed (`smooth_transitions`): distances between poses; distances
    between poses together with their velocities, which part similar poses in different motions; shortest
    paths along the motion (`time_graph_distances`), for four reaches. What is still bad is given samples of
    its own.
    """
    X = as_floats(X, "X", ("n", "m"))
    pins = {} if pins is None else pins
    distances = pose_distances(X)
    frames, _, warnings = check_pins(pins, distances)
    if len(X) < 3:
        return _small(X, distances, pins, warnings)
    path = time_path(X)
    tried: list[Judgement] = []
    for name, target in _targets(X, distances, path):
        first, result = len(tried), PoseLayout(target).solve(pins)
        tried.append(judge_layout(name, result.positions, X, result.stress, path))
        # a line has no width to smooth, and stays one
        wide = tried[-1].aspect > 1e-6 and _broad(tried[-1], tried[0])
        if tried[-1].transitions.worst > CALM and wide and len(X) <= LONGEST:
            P = smooth_transitions(result.positions, main_columns(X), target, frames)
            stress = stress_of(P, distances)
            tried.append(judge_layout(f"{name}, smoothed", P, X, stress, path))
        best = min(tried[first:], key=_badness)
        if _good(best, tried[0]):
            return _chosen(best, tried, warnings)
    best = min((t for t in tried if _broad(t, tried[0])), key=_badness)
    return _with_middles(best, tried, X, path, warnings)


def _targets(X: FloatArray, distances: FloatArray, path: Spline) -> Iterator[tuple[str, FloatArray]]:
    yield "mds", distances
    velocities = path(np.arange(len(X), dtype=np.float64), 1)
    yield "with velocities", np.hypot(distances, pose_distances(velocities))
    for reach in REACHES:
        yield f"time graph {reach:g}", time_graph_distances(distances, reach)


def pose_distances(X: FloatArray) -> FloatArray:
    """Return the distances between the poses of all frames.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates.

    Returns
    -------
    (n, n) ndarray
        Symmetric.
    """
    return squareform(pdist(X)) if X.shape[1] else np.zeros((len(X), len(X)))


def _small(X: FloatArray, distances: FloatArray, pins: Pins, warnings: tuple[str, ...]) -> LayoutChoice:
    result = PoseLayout(distances).solve(pins)
    none = np.zeros(len(X) - 1)
    nothing = np.zeros(0)
    aspect = aspect_ratio(result.positions)
    return LayoutChoice(
        result.positions,
        "mds",
        none[:0].astype(np.int64),
        aspect,
        0,
        result.stress,
        none,
        nothing,
        (),
        warnings,
    )


def _badness(judged: Judgement) -> tuple[int, float]:
    return judged.bad, judged.transitions.worst


def _broad(judged: Judgement, plain: Judgement) -> bool:
    # a motion that plain scaling lays out flat is flat: then half of that is asked for
    return judged.aspect >= min(LEAST_ASPECT, 0.5 * plain.aspect)


def _good(judged: Judgement, plain: Judgement) -> bool:
    return judged.bad == 0 and _broad(judged, plain)


def _with_middles(
    best: Judgement, tried: list[Judgement], X: FloatArray, path: Spline, warnings: tuple[str, ...]
) -> LayoutChoice:
    """Give the pose signal samples of its own where transitions are still bad."""
    middles = np.zeros(0)
    for _ in range(3):
        bad = np.flatnonzero(best.transitions.bad if len(middles) == 0 else tried[-1].transitions.bad)
        middles = np.union1d(middles, middles_of(bad))
        tried.append(judge_layout(f"{best.name} + middles", best.positions, X, best.stress, path, middles))
        if tried[-1].bad == 0:
            return _chosen(tried[-1], tried, warnings, middles)
    return _chosen(best, tried, warnings)


def _chosen(
    found: Judgement, tried: list[Judgement], warnings: tuple[str, ...], middles: FloatArray | None = None
) -> LayoutChoice:
    if found.bad:
        warnings = (
            *warnings,
            f"{found.bad} transitions stray from the smooth motion, by up to {found.transitions.worst:.2g} "
            "steps",
        )
    return LayoutChoice(
        read_only(found.positions),
        found.name,
        np.flatnonzero(found.transitions.bad),
        found.aspect,
        found.crossings,
        found.stress,
        found.transitions.deviation,
        np.zeros(0) if middles is None else middles,
        tuple(tried),
        warnings,
    )
