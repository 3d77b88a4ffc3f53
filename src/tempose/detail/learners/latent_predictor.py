"""Residuals of new poses through the latent space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tempose.detail.gplvm import BackMap, LatentPlane, LatentProcess, latent_plane
from tempose.detail.learners.features import TwoFrames
from tempose.detail.learners.scaled_poses import ScaledPoses
from tempose.detail.training import Inputs, Mixture
from tempose.typing import FloatArray, IntArray

Poses: TypeAlias = TwoFrames | ScaledPoses
"""What makes columns of inputs."""


@dataclass(frozen=True)
class TrainingFrames:
    """Which frames a latent model was made from."""

    frames: IntArray
    """(k,) those of the training that have latent points."""
    n_frames: int
    """Frames T of the training."""
    variance: float
    """Variance of one coordinate of the residuals over those frames, times what blocks left out say that
    predicted variances lack, metres squared."""
    warnings: tuple[str, ...] = ()
    """Sentences for the report."""


@dataclass(frozen=True, eq=False)
class LatentPredictor:
    """A trained latent model: poses are placed in the latent space, residuals read off there."""

    features: Poses
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
