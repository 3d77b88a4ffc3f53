"""The residual of the training frame that is most alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.features import Features
from tempose.detail.training import Inputs, Mixture, Training
from tempose.regression import blocked_folds
from tempose.typing import FloatArray


@dataclass(frozen=True)
class NearestLearner:
    """Looks up the frame with the nearest angles and, at half the weight, velocities."""

    momentum: float = 0.5
    """Weight of velocities beside angles, both at variance 1."""
    name: str = "nearest"
    """Name in tables and options."""

    def fit(self, training: Training) -> NearestPredictor:
        """Remember T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        NearestPredictor
            Looks up frames.
        """
        inputs = training.inputs
        features = Features.of(inputs, per_joint=False)
        weight = np.where(features.blocks(inputs) == 1, self.momentum, 1.0)
        X = features(inputs) * weight
        wrong = _left_out(X, training)
        return NearestPredictor(features, weight, X, float(wrong / training.sizes.sum()))


def _left_out(X: FloatArray, training: Training) -> float:
    """Mean squared distance of residuals to those of the frame found for them in other blocks."""
    G = training.gram
    squares = np.diagonal(G)
    found: list[FloatArray] = []
    for train, test in blocked_folds(training.inputs.chains):
        if len(train):
            near = train[_distances(X[test], X[train]).argmin(axis=1)]
            found.append(squares[test] + squares[near] - 2 * G[test, near])
    return float(np.mean(np.concatenate(found))) if found else float(squares.mean())


def _distances(A: FloatArray, B: FloatArray) -> FloatArray:
    return np.square(A).sum(axis=1)[:, None] + np.square(B).sum(axis=1) - 2 * A @ B.T


@dataclass(frozen=True, eq=False)
class NearestPredictor:
    """Looks up the most alike of T frames."""

    features: Features
    """Columns of the inputs."""
    weight: FloatArray
    """(P,) factor on each."""
    X: FloatArray
    """(T, P) columns of the training, times their factors."""
    wrong: float
    """Mean squared error of one coordinate of frames left out in blocks, metres squared."""

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the residuals of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            One frame each; the same variance for all.
        """
        near = _distances(self.features(inputs) * self.weight, self.X).argmin(axis=1)
        weights = np.zeros((1, len(inputs), len(self.X)))
        weights[0, np.arange(len(inputs)), near] = 1.0
        return Mixture(weights, np.full((len(inputs), 1), self.wrong))
