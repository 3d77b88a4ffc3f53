"""The mean residual of the training: the baseline that 'better than skinning alone' has to beat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.training import Inputs, Mixture, Training


@dataclass(frozen=True)
class MeanLearner:
    """Predicts the mean, always."""

    name: str = "mean"
    """Name in tables and options."""

    def fit(self, training: Training) -> MeanPredictor:
        """Note how far the residuals are from their mean.

        Parameters
        ----------
        training : Training
            T frames.

        Returns
        -------
        MeanPredictor
            Predicts the mean.
        """
        T = len(training.inputs)
        spread = np.trace(training.centred_gram) / (T * training.sizes.sum())
        return MeanPredictor(T, float(spread))


@dataclass(frozen=True)
class MeanPredictor:
    """Predicts the mean, always."""

    n_frames: int
    """Frames T of the training."""
    spread: float
    """Variance of one coordinate over the training, metres squared."""

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the mean.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            Weights of zero.
        """
        Q = len(inputs)
        return Mixture(np.zeros((1, Q, self.n_frames)), np.full((Q, 1), self.spread))
