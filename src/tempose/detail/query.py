"""Frames that a model is asked about, brought to the rate of the training: learners count in its frames."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import SkeletonClip
from tempose.clips.resample import resample
from tempose.detail.checks import check_joints
from tempose.detail.inputs import motion_inputs
from tempose.detail.training import Inputs
from tempose.rigging import Rig
from tempose.typing import FloatArray, IntArray

_SNAP = 1e-6
"""Part of a frame below which a moment counts as the frame itself."""


@dataclass(frozen=True, eq=False)
class Query:
    """Moments at which a learner is asked, and where between them the T frames of a motion are."""

    inputs: Inputs
    """Q moments in chains; those of a chain are a frame of the training apart."""
    before: IntArray
    """(T,) moment at or before each frame."""
    after: IntArray
    """(T,) moment after it."""
    part: FloatArray
    """(T,) how far the frame is from the one to the other."""

    def frames(self, values: FloatArray) -> FloatArray:
        """Return what is known at moments for the frames.

        Parameters
        ----------
        values : (Q, ...) float
            Known at moments.

        Returns
        -------
        (T, ...) ndarray
            In between, by straight lines.
        """
        first = values[self.before]
        if not self.part.any():
            return first
        part = self.part.reshape(-1, *[1] * (values.ndim - 1)).astype(values.dtype)
        return first + part * (values[self.after] - first)


def make_query(rig: Rig, motion: SkeletonClip, fps: float, near: FloatArray) -> Query:
    """Read a motion that is to be posed.

    Parameters
    ----------
    rig : Rig
        Whose joints it must move.
    motion : SkeletonClip
        T frames at any rate.
    fps : float
        Rate of the training.
    near : (K, 3) float
        Mean rotation vectors of the training.

    Returns
    -------
    Query
        At a multiple m of the rate of the training that is as dense as the motion; every m-th moment belongs
        to one chain, so that learners find the frames before where they were in the training.

    Raises
    ------
    ValueError
        If it moves other joints, or they rest otherwise, or it has no frames.
    """
    check_joints(rig, motion)
    if motion.n_frames == 0:
        raise ValueError("motion must have one frame or more, got none")
    T = motion.n_frames
    m = max(1, math.ceil(motion.fps / fps - _SNAP))
    dense = motion if abs(m * fps - motion.fps) < _SNAP * fps else resample(motion, m * fps)
    inputs = motion_inputs(dense, fps, near)
    Q = len(inputs)
    order = np.argsort(np.arange(Q) % m, kind="stable")
    rank = np.argsort(order, kind="stable")
    moment = np.arange(T) * (m * fps / motion.fps)
    before = np.minimum(np.floor(moment + _SNAP).astype(np.int64), Q - 1)
    part = np.clip(moment - before, 0.0, 1.0)
    part[part < _SNAP * T] = 0.0
    after = np.minimum(before + 1, Q - 1)
    chained = replace(inputs.take(order), chains=order % m)
    return Query(chained, rank[before], rank[after], part)
