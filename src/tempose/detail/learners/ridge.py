"""Residuals as a linear function of angles and velocities."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose.detail.learners.features import Features
from tempose.detail.training import Inputs, Mixture, Training
from tempose.regression import RidgeRegression, blocked_folds
from tempose.typing import FloatArray


@dataclass(frozen=True)
class RidgeLearner:
    """Ridge regression; the penalty is chosen by blocks left out."""

    penalties: tuple[float, ...] = tuple(10.0**e for e in np.arange(-6.0, 2.1, 0.5))
    """Tried, as parts of the variance of the inputs times the number of frames."""
    momentum: float = 0.5
    """Weight of velocities beside angles, both at variance 1."""
    name: str = "ridge"
    """Name in tables and options."""

    def fit(self, training: Training) -> RidgePredictor:
        """Learn from T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        RidgePredictor
            A linear function.
        """
        inputs = training.inputs
        features = Features.of(inputs, per_joint=False)
        weight = np.where(features.blocks(inputs) == 1, self.momentum, 1.0)
        X = features(inputs) * weight
        S = training.centred_gram
        wrong = self._left_out(X, S, training)
        best = int(wrong.argmin())
        regression = RidgeRegression(X)
        penalty = self.penalties[best] * len(X) * max(regression.spread, 1e-12)
        return RidgePredictor(features, weight, X, penalty, wrong[best] / training.sizes.sum())

    def _left_out(self, X: FloatArray, S: FloatArray, training: Training) -> FloatArray:
        """Mean squared error a frame for each penalty."""
        wrong = np.zeros(len(self.penalties))
        for train, test in blocked_folds(training.inputs.chains):
            if not len(train):
                return wrong + np.trace(S) / len(X)
            regression = RidgeRegression(X[train])
            unit = len(train) * max(regression.spread, 1e-12)
            for i, penalty in enumerate(self.penalties):
                lines = np.zeros((len(test), len(X)))
                W = regression.weights(X[test], penalty * unit)
                lines[:, train] = -W + (W.sum(axis=1, keepdims=True) - 1) / len(train)
                lines[np.arange(len(test)), test] += 1
                wrong[i] += np.einsum("qt,qt->", lines @ S, lines)
        return wrong / len(X)


@dataclass(frozen=True, eq=False)
class RidgePredictor:
    """A linear function of angles and velocities."""

    features: Features
    """Columns of the inputs."""
    weight: FloatArray
    """(P,) factor on each."""
    X: FloatArray
    """(T, P) columns of the training, times their factors."""
    penalty: float
    """On squared slopes."""
    wrong: float
    """Mean squared error of one coordinate of frames left out in blocks, metres squared."""
    regression: RidgeRegression = field(init=False)
    """`X`, factorised."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "regression", RidgeRegression(self.X))

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the residuals of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            Weights of the training frames; the same variance for all.
        """
        W = self.regression.weights(self.features(inputs) * self.weight, self.penalty)
        return Mixture(W[None], np.full((len(inputs), 1), self.wrong))
