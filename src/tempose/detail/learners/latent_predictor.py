"""Residuals of new poses through the latent space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.gplvm import BackMap, LatentPlane, LatentProcess, latent_plane
from tempose.detail.learners.features import Features, TwoFrames
from tempose.detail.training import Inputs, Mixture
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Scaled:
    """Angles and velocities as columns, velocities at a lower weight."""

    features: Features
    """Columns, each block at variance 1."""
    momentum: float
    """Weight of velocities beside angles."""

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
        return self.features(inputs) * np.where(self.features.blocks(inputs) == 1, self.momentum, 1.0)

    def groups(self, inputs: Inputs) -> IntArray:
        """Return the group of every column: angles, velocities, further inputs.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        (P,) ndarray
            Groups from 0.
        """
        return np.unique(self.features.blocks(inputs), return_inverse=True)[1]


@dataclass(frozen=True)
class TrainingFrames:
    """Which frames a latent model was made from."""

    frames: IntArray
    """(k,) those of the training that have latent points."""
    n_frames: int
    """Frames T of the training."""
    variance: float
    """Variance of one coordinate of the residuals over those frames, metres squared."""
    warnings: tuple[str, ...] = ()
    """Sentences for the report."""


@dataclass(frozen=True, eq=False)
class LatentPredictor:
    """A trained latent model: poses are placed in the latent space, residuals read off there."""

    features: Features | TwoFrames | Scaled
    """Columns that stand for a pose."""
    basis: TrainingFrames
    """What it was made from."""
    back: BackMap | None
    """From poses to latent points; None where there was nothing to learn and the mean is predicted."""
    process: LatentProcess | None
    """From latent points to residuals."""
    expected: bool = True
    """Whether the variance of the latent point enters the prediction."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the report."""
        return self.basis.warnings

    @property
    def latent(self) -> FloatArray:
        """(k, q) latent points of the frames of the training."""
        return np.zeros((0, 0)) if self.process is None else self.process.X

    def latent_of(self, inputs: Inputs) -> FloatArray:
        """Place poses in the latent space.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        (Q, q) ndarray
            Latent points.
        """
        return np.zeros((len(inputs), 0)) if self.back is None else self.back(self.features(inputs))[0]

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the residuals of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            Weights of the training frames, variances; the same for all regions.
        """
        Q = len(inputs)
        weights = np.zeros((1, Q, self.basis.n_frames))
        if self.back is None or self.process is None:
            return Mixture(weights, np.full((Q, 1), self.basis.variance))
        points, unsure = self.back(self.features(inputs))
        unsure = unsure if self.expected else np.zeros(Q)
        weights[0][:, self.basis.frames] = self.process.weights(points, unsure)
        return Mixture(weights, self.basis.variance * self.process.variance(points, unsure)[:, None])

    def plane(self, inputs: Inputs | None = None, size: int = 80) -> LatentPlane:
        """Look at the latent space: the two widest directions, with the variance of residuals.

        Parameters
        ----------
        inputs : Inputs, optional
            Q frames to show beside those of the training.
        size : int, default 80
            Cells a side.

        Returns
        -------
        LatentPlane
            What a plot draws.

        Raises
        ------
        ValueError
            If there was nothing to learn, so that there is no latent space.
        """
        if self.process is None:
            raise ValueError("there is no latent space: the training held too few frames or nothing moved")
        queries = None if inputs is None else self.latent_of(inputs)
        return latent_plane(self.process, queries, size)
