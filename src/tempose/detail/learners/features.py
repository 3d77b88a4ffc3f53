"""Columns that a learner sees of its inputs, in groups that share a length scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.memory import frame_ages, past
from tempose.detail.training import Inputs
from tempose.typing import FloatArray, IntArray

_LEAST = 1e-9
"""Spread below which a block of inputs is constant: its scale is then 1."""


@dataclass(frozen=True, eq=False)
class Features:
    """Angles, velocities of some frames and further inputs as columns, each block at variance 1."""

    scales: FloatArray
    """(3 + E,) of angles, velocities, nothing, and every further input: what they are divided by."""
    lags: tuple[int, ...] = (0,)
    """Frames back at which velocities are seen, ascending."""
    per_joint: bool = True
    """Whether every joint has a group of its own, for its angle and for its latest velocity."""

    @staticmethod
    def of(inputs: Inputs, lags: tuple[int, ...] = (0,), per_joint: bool = True) -> Features:
        """Measure the spread of the inputs of a training.

        Parameters
        ----------
        inputs : Inputs
            T frames.
        lags : tuple of int, default (0,)
            Frames back at which velocities are seen, ascending.
        per_joint : bool, default True
            Whether every joint has groups of its own.

        Returns
        -------
        Features
            Which bring each block of those inputs to variance 1.
        """
        spreads = [
            np.sqrt(part.reshape(len(part), -1).var(axis=0).sum())
            for part in (inputs.angles, inputs.velocity)
        ]
        scales = np.array([*spreads, *inputs.extra.std(axis=0)])
        return Features(np.where(scales > _LEAST, scales, 1.0), lags, per_joint)

    def __call__(self, inputs: Inputs) -> FloatArray:
        """Return the columns of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        (Q, P) ndarray
            Columns.
        """
        Q = len(inputs)
        blocks = [inputs.angles.reshape(Q, -1) / self.scales[0]]
        blocks += [
            past(inputs.velocity, inputs.chains, lag).reshape(Q, -1) / self.scales[1] for lag in self.lags
        ]
        return np.concatenate([*blocks, inputs.extra / self.scales[2:]], axis=1)

    def groups(self, inputs: Inputs) -> IntArray:
        """Return the group of every column.

        Parameters
        ----------
        inputs : Inputs
            From which joints and further inputs are counted.

        Returns
        -------
        (P,) ndarray
            Groups from 0; see `blocks` for what they are parts of.
        """
        K = inputs.angles.shape[1]
        joints = np.repeat(np.arange(K), 3)
        parts = [joints if self.per_joint else 0 * joints]
        for lag in self.lags:
            own = self.per_joint and lag == self.lags[0]
            parts.append(parts[-1].max(initial=-1) + 1 + (joints if own else 0 * joints))
        E = inputs.extra.shape[1]
        width = 3 if E % 3 == 0 else 1
        parts.append(parts[-1].max(initial=-1) + 1 + np.arange(E) // width)
        return np.concatenate(parts)

    def unknown(self, inputs: Inputs) -> FloatArray:
        """Estimate how far columns are off because a clip is younger than what they look back to.

        Parameters
        ----------
        inputs : Inputs
            T frames.

        Returns
        -------
        (T, G) ndarray
            Expected squared error of every group: what is measured where the clip is old enough.
        """
        groups, blocks, ages = self.groups(inputs), self.blocks(inputs), frame_ages(inputs.chains)
        off = np.zeros((len(inputs), groups.max(initial=-1) + 1))
        moved = inputs.velocity.reshape(len(inputs), -1) / self.scales[1]
        for block, lag in enumerate(self.lags, start=1):
            old = np.flatnonzero(ages >= lag)
            for age in range(lag if len(old) else 0):
                apart = np.square(moved[old - lag] - moved[old - age]).mean(axis=0)
                errors = np.bincount(groups[blocks == block], apart, minlength=off.shape[1])
                off[ages == age] += errors
        return off

    def blocks(self, inputs: Inputs) -> IntArray:
        """Return the block of every column: angles, velocities of each lag, further inputs.

        Parameters
        ----------
        inputs : Inputs
            From which joints and further inputs are counted.

        Returns
        -------
        (P,) ndarray
            Blocks from 0.
        """
        sizes = [3 * inputs.angles.shape[1]] * (1 + len(self.lags)) + [inputs.extra.shape[1]]
        return np.repeat(np.arange(len(sizes)), sizes)


@dataclass(frozen=True)
class TwoFrames:
    """Angles of a frame and of the frame before, as they are: what the paper learns from."""

    def __call__(self, inputs: Inputs) -> FloatArray:
        """Return the columns of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        (Q, 6 K) ndarray
            Rotation vectors of both frames, radians.
        """
        Q = len(inputs)
        before = inputs.angles - inputs.velocity
        return np.concatenate([inputs.angles.reshape(Q, -1), before.reshape(Q, -1)], axis=1)
