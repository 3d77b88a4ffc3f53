"""Poses in which every joint counts by how much residuals depend on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.features import Features
from tempose.detail.learners.kernel_predictor import spread_frames
from tempose.detail.training import Inputs
from tempose.regression import Kernel, fit_kernel
from tempose.typing import FloatArray, IntArray

_PRIOR = 0.5
"""Weight of the squared distance of the logarithmic scales of joints from that of all."""
_ITERATIONS = 25
_JUDGED = 160
"""At most so many frames, spread evenly, judge scales."""


@dataclass(frozen=True, eq=False)
class ScaledPoses:
    """Angles and velocities as columns, each joint over its length scale.

    A latent model has to explain the whole pose. Where joints move that residuals do not follow, it spends
    its dimensions on them; over length scales found by a Gaussian process they hardly move.
    """

    features: Features
    """Columns, angles and velocities at variance 1."""
    weights: FloatArray
    """(P,) factor on each."""

    @staticmethod
    def of(inputs: Inputs, residuals: FloatArray) -> ScaledPoses:
        """Find the length scale of every joint, for its angle and its velocity.

        Parameters
        ----------
        inputs : Inputs
            T frames.
        residuals : (T, T) float
            Gram matrix of the centred residuals, trace T.

        Returns
        -------
        ScaledPoses
            Columns of mean variance 1 / P.
        """
        features = Features.of(inputs)
        groups = features.groups(inputs)
        columns = np.unique(features.blocks(inputs), return_inverse=True)[1]
        some = spread_frames(len(inputs), _JUDGED)
        X, S = features(inputs)[some], residuals[np.ix_(some, some)]
        whole = fit_kernel(X, columns, S, iterations=_ITERATIONS).kernel
        precision = np.ones(groups.max(initial=-1) + 1)
        precision[groups] = whole.precision[columns]
        start = Kernel(whole.smooth, whole.linear, whole.noise, precision, groups)
        own = fit_kernel(X, groups, S, starts=[start], prior=_PRIOR, iterations=_ITERATIONS).kernel
        weights = np.sqrt(own.precision[groups])
        spread = float((X.var(axis=0) * weights**2).sum())
        return ScaledPoses(features, weights / np.sqrt(spread if spread > 0 else 1.0))

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
        return self.features(inputs) * self.weights

    def blocks(self, inputs: Inputs) -> IntArray:
        """Return the block of every column: angles, velocities, further inputs.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        (P,) ndarray
            Blocks from 0, none empty.
        """
        return np.unique(self.features.blocks(inputs), return_inverse=True)[1]
