"""Signals of a clip that does not move."""

from __future__ import annotations

import numpy as np

from tempose.clips import MeshClip
from tempose.curves import MonotoneMap, Spline
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.signals import Signals
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


def still_signals(shape: ShapeSignal, clip: MeshClip, placement: Spline | None = None) -> Signals:
    """Return the signals of one pose held: a shape signal of no dimension, a curve that stays in place.

    Parameters
    ----------
    shape : ShapeSignal
        With m = 0 components.
    clip : MeshClip
        T >= 2 frames: how long it lasts, and its topology.
    placement : Spline, optional
        Where the body is, if it was split off: a rigid body may move.

    Returns
    -------
    Signals
        Every time gives the pose of `shape`.
    """
    last = clip.n_frames - 1.0
    curve = _resting(last, 2)
    pace = MonotoneMap(np.array([0.0, last]), np.array([0.0, last]), np.ones(2))
    pose = PoseSignal(np.zeros((0, 2)), np.zeros((0, 0)), np.zeros((3, 0)), np.zeros(2), 1.0)
    time = TimeSignal(curve, curve, pace)
    return Signals(shape, pose, time, _resting(last, 0), placement, (), clip.fps, clip.fps, clip.mesh)


def _resting(last: float, c: int) -> Spline:
    knots: FloatArray = np.repeat([0.0, last], 4)
    return Spline(knots, np.zeros((4, c)))
