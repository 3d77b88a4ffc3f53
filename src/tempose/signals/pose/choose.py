"""The layout of a clip in the pose plane, chosen so that transitions between frames are good."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist, squareform

from tempose._validate import as_floats, read_only
from tempose.curves import Spline, interpolating_spline
from tempose.signals.pose.judge import Judgement, aspect_ratio, curve_through, judge_layout
from tempose.signals.pose.layout import PoseLayout
from tempose.signals.pose.pins import Pins, check_pins
from tempose.signals.pose.time_graph import time_graph_distances
from tempose.typing import FloatArray, IntArray

REACHES = (np.inf, 4.0, 3.0, 2.5, 2.0)
"""Reaches tried, in steps: see `time_graph_distances`."""

LEAST_ASPECT = 0.2
"""A layout flatter than this has become a line along time."""

_LADDER = (np.inf, 4.0, 3.0, 2.5, 2.0, 1.5)
_ROUNDS = 8


@dataclass(frozen=True, eq=False)
class LayoutChoice:
    """The layout chosen, and what else was tried."""

    positions: FloatArray
    """(n, 2) places of the frames."""
    name: str
    """How it was made: ``"mds"``, ``"time graph 4"``, ``"local"``, with ``" + middles"`` if there are any."""
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
        if len(self.middles) == 0:
            return self.positions, X
        path = interpolating_spline(np.arange(len(X), dtype=np.float64), X)
        between = curve_through(self.positions)(self.middles)
        return np.concatenate([self.positions, between]), np.concatenate([X, path(self.middles)])


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
        Plain scaling where its transitions are good; else the first layout of distances along the motion
        that has none that are bad and is no mere line; else the best of them, repaired where it is bad.

    Raises
    ------
    ValueError
        If `X` is not finite or the pins contradict it.
    """
    X = as_floats(X, "X", ("n", "m"))
    pins = {} if pins is None else pins
    distances = pose_distances(X)
    _, _, warnings = check_pins(pins, distances)
    if len(X) < 3:
        return _small(X, distances, pins, warnings)
    path = interpolating_spline(np.arange(len(X), dtype=np.float64), X)
    tried: list[Judgement] = []
    for reach in REACHES:
        name = "mds" if np.isinf(reach) else f"time graph {reach:g}"
        tried.append(_attempt(name, X, distances, reach, pins, path, None))
        if tried[-1].bad == 0 and _broad(tried[-1], tried[0]):
            return _chosen(tried[-1], tried, warnings)
    best = min((t for t in tried if _broad(t, tried[0])), key=_badness)
    return _repaired(best, tried, X, distances, pins, path, warnings)


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


def _attempt(
    name: str,
    X: FloatArray,
    distances: FloatArray,
    reach: FloatArray | float,
    pins: Pins,
    path: Spline,
    start: FloatArray | None,
) -> Judgement:
    result = PoseLayout(time_graph_distances(distances, reach)).solve(pins, start)
    return judge_layout(name, result.positions, X, result.stress, path)


def _repaired(
    best: Judgement,
    tried: list[Judgement],
    X: FloatArray,
    distances: FloatArray,
    pins: Pins,
    path: Spline,
    warnings: tuple[str, ...],
) -> LayoutChoice:
    """Shorten the reach of the frames at bad transitions only, round after round."""
    for base in [t for t in tried if _broad(t, tried[0])][:3]:
        level = np.full(len(X), tried.index(base))
        current = base
        for _ in range(_ROUNDS):
            beside = np.flatnonzero(current.transitions.bad)
            for i in beside:
                level[max(i - 1, 0) : i + 3] += 1
            level = np.minimum(level, len(_LADDER) - 1)
            current = _attempt("local", X, distances, np.array(_LADDER)[level], pins, path, current.positions)
            tried.append(current)
            if _broad(current, tried[0]) and _badness(current) < _badness(best):
                best = current
            if best.bad == 0:
                return _chosen(best, tried, warnings)
    return _with_middles(best, tried, X, path, warnings)


def _with_middles(
    best: Judgement, tried: list[Judgement], X: FloatArray, path: Spline, warnings: tuple[str, ...]
) -> LayoutChoice:
    """Give the pose signal samples of its own where transitions are still bad."""
    middles = np.zeros(0)
    for _ in range(3):
        middles = np.union1d(middles, np.flatnonzero(best.transitions.bad) + 0.5)
        found = judge_layout(f"{best.name} + middles", best.positions, X, best.stress, path, middles)
        tried.append(found)
        if found.bad == 0:
            return _chosen(found, tried, warnings, middles)
    found = min(tried, key=_badness)
    return _chosen(found, tried, warnings, middles if found is tried[-1] else np.zeros(0))


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
