"""Signals of a clip that does not move."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh
from tempose.curves import MonotoneMap, Spline
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.signals import Signals
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


def still_signals(shape: ShapeSignal, T: int, fps: float, mesh: Mesh) -> Signals:
    """Return the signals of one pose held: a shape signal of no dimension, a curve that stays in place.

    Parameters
    ----------
    shape : ShapeSignal
        With m = 0 components.
    T : int
        Frames, 2 or more.
    fps : float
        Frames per second.
    mesh : Mesh
        Topology.

    Returns
    -------
    Signals
        Every time gives the pose of `shape`.
    """
    curve = _resting(T, 2)
    pace = MonotoneMap(np.array([0.0, T - 1.0]), np.array([0.0, T - 1.0]), np.ones(2))
    pose = PoseSignal(np.zeros((0, 2)), np.zeros((0, 0)), np.zeros((3, 0)), np.zeros(2), 1.0)
    time = TimeSignal(curve, curve, pace)
    return Signals(shape, pose, time, _resting(T, 0), None, (), fps, fps, mesh)


def _resting(T: int, c: int) -> Spline:
    knots: FloatArray = np.repeat([0.0, T - 1.0], 4)
    return Spline(knots, np.zeros((4, c)))
