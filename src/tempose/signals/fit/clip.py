"""A clip becomes signals: the stages of section 3 of the paper, in their order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.clips import MeshClip
from tempose.curves import Spline
from tempose.shape_spaces import ShapeSpace, VertexSpace, shape_space
from tempose.signals.fit.fidelity import SHAPE_SHARE
from tempose.signals.fit.frames import ClipFrames, example_vertices
from tempose.signals.fit.notes import Notes
from tempose.signals.fit.options import FitOptions, check_pins
from tempose.signals.fit.plane import Goal, Plane, fit_plane, fit_time, turned
from tempose.signals.fit.still import still_signals
from tempose.signals.placement import placement_spline
from tempose.signals.pose.transitions import find_bad_transitions
from tempose.signals.room import check_room
from tempose.signals.shape.fit import FittedShape, Percent, checked_frames, fit_examples, fit_shape, rescaled
from tempose.signals.shape.streamed import fit_streamed_shape, streamed_space
from tempose.signals.signals import Signals
from tempose.signals.time.path import time_path
from tempose.signals.time.period import find_period
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray, IntArray, Progress, silent

MEASURED_VERTICES = 1000
"""Vertices whose motion says whether a clip repeats, where coordinates are no vertices."""

LEAST_SHARE = 0.05
"""Without a tolerance given, at most so much of a clip's own motion is left out."""

_SAFETY = 1.05

_WIDEST = 18
"""Numbers that a shape space has for a vertex at most: 9 for a face, of which there are two."""


@dataclass(frozen=True, eq=False)
class FittedClip:
    """Signals of a clip, and what led to them."""

    signals: Signals
    """h, g, f and the time spline."""
    shape: FittedShape
    """What h leaves out."""
    plane: Plane | None
    """Places of the frames and g as it was fitted to them; None for a clip that does not move."""
    diagonal: float
    """D, metres."""
    notes: Notes
    """Seconds, warnings, facts."""

    @property
    def positions(self) -> FloatArray:
        """(T, 2) places of the frames in the pose plane."""
        return np.zeros((len(self.shape.X), 2)) if self.plane is None else self.plane.positions

    @property
    def site_frames(self) -> IntArray:
        """(l,) frames at whose places the sites of g stand."""
        return np.zeros(0, np.int64) if self.plane is None else self.plane.site_frames

    @property
    def pose_left_out(self) -> FloatArray:
        """(T,) squared residual of g at the places of the frames."""
        return np.zeros(len(self.shape.X)) if self.plane is None else self.plane.left_out


def fit_clip(
    clip: MeshClip,
    options: FitOptions,
    pins: Mapping[int, Any] | None = None,
    examples: Any = None,
    progress: Progress = silent,
) -> FittedClip:
    """Fit signals to a clip.

    Parameters
    ----------
    clip : MeshClip
        T frames, 2 or more.
    options : FitOptions
        Checked options.
    pins : mapping of int to (x, y), optional
        Places of frames in the pose plane.
    examples : (m + 1, n, 3) float or sequence of Mesh, optional
        Poses that span the shape signal instead of principal components.
    progress : Progress, optional
        Told which stage is at work.

    Returns
    -------
    FittedClip
        The signals.

    Raises
    ------
    ValueError
        If the clip is too short, or k, l, m, a pin or the examples do not suit it.
    """
    Q = example_vertices(examples, clip.mesh)
    options.check_frames(clip.n_frames, None if Q is None else len(Q) - 1)
    pins = check_pins(pins, clip.n_frames)
    notes = Notes(progress)
    with notes.stage("frames"):
        frames = ClipFrames.of(clip, options.placement, progress)
    shape, limit = _fit_shape(frames, options, Q, notes)
    placement = None if frames.placements is None else placement_spline(frames.placements)
    if shape.X.shape[1] == 0:
        signals = still_signals(shape.shape, clip, placement)
        _note_stillness(shape, notes)
        return FittedClip(signals, shape, None, frames.diagonal, notes)
    shape, plane, f, pose = _fit_rest(frames, shape, options, pins, limit, notes)
    path = _path(frames, shape, options, notes) if options.between == "path" else None
    g: Any = turned(pose, shape.turn)
    signals = Signals(shape.shape, g, f, path, placement, (), clip.fps, clip.fps, clip.mesh)
    _note_transitions(signals, shape.X, notes)
    return FittedClip(signals, shape, plane, frames.diagonal, notes)


def _fit_shape(
    frames: ClipFrames, options: FitOptions, Q: FloatArray | None, notes: Notes
) -> tuple[FittedShape, float]:
    """Fit the shape signal; also return the tolerance it was held to."""
    clip, limit = frames.clip, options.percent
    if options.tolerance is None:
        limit = min(limit, LEAST_SHARE * frames.motion())
    if frames.streamed(options.m, options.space) and Q is None:
        with notes.stage("shape"):
            space = streamed_space(options.space, frames)
            return fit_streamed_shape(space, frames, options.m, SHAPE_SHARE * limit, notes.progress), limit
    check_room(
        3 * 8e-9 * clip.n_frames * _WIDEST * len(clip.rest),
        f"{clip.n_frames} frames in the shape space {options.space!r}",
        "take fewer frames, or the vertex space, which reads them from the file",
    )
    V = frames.block(slice(None))
    with notes.stage("encode"):
        known = V if Q is None else np.concatenate([V, Q])
        space = shape_space(options.space, clip.rest, clip.faces, known)
        Z = space.encode_path(V)
        E = None if Q is None else space.encode(Q)
    with notes.stage("shape"):
        check = None if isinstance(space, VertexSpace) else _decoded_percent(space, V, frames.diagonal)
        if E is None:
            shape = fit_shape(space, Z, options.m, SHAPE_SHARE * limit, frames.percent, check)
        else:
            shape = fit_examples(space, Z, E, frames.percent)
            shape = shape if check is None else rescaled(shape, check)
    if options.m is not None and shape.X.shape[1] < options.m:
        notes.warnings.append(f"m {options.m} was asked for; the frames span {shape.X.shape[1]} dimensions")
    return shape, limit


def _fit_rest(
    frames: ClipFrames,
    shape: FittedShape,
    options: FitOptions,
    pins: Mapping[int, FloatArray],
    limit: float,
    notes: Notes,
) -> tuple[FittedShape, Plane, TimeSignal, Any]:
    """Fit g and f; where coordinates are no vertices, anew until decoded frames meet the tolerance too."""
    X, mark = shape.straight, len(notes.warnings)
    for last in (False, False, True):
        del notes.warnings[mark:]
        goal = _goal(shape, limit)
        plane = fit_plane(X, options, pins, goal, notes)
        f, pose = fit_time(plane, X, options, goal, notes)
        ratio = 0.0 if last or options.complete else _measured(frames, shape, f, pose) / limit
        if ratio <= 1:
            break
        shape = replace(shape, scale=shape.scale * ratio * _SAFETY)
    return shape, plane, f, pose


def _measured(frames: ClipFrames, shape: FittedShape, f: TimeSignal, pose: Any) -> float:
    """Rms percent of decoded frames of the literal psi; 0 where coordinates are vertices and it is known."""
    space = shape.shape.space
    if isinstance(space, VertexSpace) or shape.turn is not None:
        return 0.0
    which = checked_frames(len(shape.X), space.name)
    ticks = which.astype(np.float64)
    V = frames.block(which)
    measure = _decoded_percent(space, V, frames.diagonal)
    Z = shape.shape.mean + pose(f(ticks), ticks) @ shape.shape.components
    return measure(Z, np.arange(len(which)))


def _decoded_percent(space: ShapeSpace, V: FloatArray, diagonal: float) -> Percent:
    def measure(Z: FloatArray, which: IntArray) -> float:
        off = space.decode(Z) - V[which]
        return 100.0 / diagonal * float(np.sqrt(np.square(off).sum() * 3 / max(off.size, 1)))

    return measure


def _goal(shape: FittedShape, limit: float) -> Goal:
    # examples are the user's choice: what they leave out is not held against g and f
    base = float(shape.left_out.sum()) if shape.turn is None else 0.0
    return Goal(base, (limit / shape.scale) ** 2 if shape.scale > 0 else np.inf)


def _path(frames: ClipFrames, shape: FittedShape, options: FitOptions, notes: Notes) -> Spline:
    """Return the time spline; of a clip that repeats, all cycles say together what lies between frames."""
    with notes.stage("path"):
        if options.period == "auto":
            found = find_period(_places(frames, shape))
            notes.facts["period"] = None if found is None else found.ticks
            return time_path(shape.X, found.ticks if found is not None and found.interleaves else None)
        period = None if options.period is None else float(options.period)
        notes.facts["period"] = period
        return time_path(shape.X, period)


def _places(frames: ClipFrames, shape: FittedShape) -> FloatArray:
    # where vertices are tells more about a period than angles and stretches of small faces do
    if isinstance(shape.shape.space, VertexSpace):
        return shape.straight
    V = frames.block(slice(None))
    return V[:, :: max(V.shape[1] // MEASURED_VERTICES, 1)].reshape(len(V), -1)


def _note_stillness(shape: FittedShape, notes: Notes) -> None:
    left = float(shape.percent(shape.left_out.sum()))
    if left > 0:
        notes.warnings.append(
            f"m = 0: one pose stands for all frames, which move by {left:.3g} % of the diagonal about it"
        )


def _note_transitions(signals: Signals, X: FloatArray, notes: Notes) -> None:
    found = find_bad_transitions(signals.pose, signals.time, X, path=signals.path)
    bad = np.flatnonzero(found.bad)
    notes.facts["transitions"] = {"bad": bad.tolist(), "worst": found.worst, "limit": found.limit}
    if len(bad):
        notes.warnings.append(
            f"{len(bad)} of {len(found.deviation)} transitions of g(f(t)) stray from the smooth motion, by "
            f"up to {found.worst:.2g} steps, first after frame {bad[0]}"
            + ("; playback follows the smooth motion, edits there may not" if signals.path else "")
        )
