"""The shared latent model as a learner: exactly as in the paper, and in its better setting."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tempose.detail.gplvm import (
    LatentFit,
    LatentProcess,
    centred_gram,
    fit_back_map,
    latent_start,
    train_latent,
    unit_gram,
)
from tempose.detail.learners.features import Features, TwoFrames
from tempose.detail.learners.kernel_predictor import spread_frames
from tempose.detail.learners.latent_predictor import LatentPredictor, Scaled, TrainingFrames
from tempose.detail.training import Inputs, Training
from tempose.regression import one_blas_thread
from tempose.typing import FloatArray, IntArray, Progress, silent

FEWEST = 3
"""Frames below which there is nothing to learn: the mean is predicted."""


@dataclass(frozen=True)
class LatentLearner:
    """Shared Gaussian process latent variable model with dynamics.

    Poses and residuals are Gaussian processes over one latent point a frame, and every latent point is one
    over the point before. The default differs from the paper, each time for a measured reason: 16 latent
    dimensions for 4, likelihoods divided by their dimensions so that 30 000 vertex coordinates do not drown
    the rest, a start from poses and residuals together, angles and velocities at variances of their own, and
    a prediction that knows how unsure the latent point is. `paper` has the paper's setting.

    Notes
    -----
    Section 5 of [1]_; the dynamics are those of [2]_.

    References
    ----------
    .. [1] de Aguiar and Ukita, "Representing mesh-based character animations", Computers & Graphics 38, 2014.
    .. [2] Wang, Fleet and Hertzmann, "Gaussian process dynamical models for human motion", IEEE Transactions
       on Pattern Analysis and Machine Intelligence 30, 2008.
    """

    dim: int = 16
    """Latent dimensions q; fewer where there are not more frames."""
    balanced: bool = True
    """Whether each likelihood is divided by its dimension; otherwise their plain product is maximised."""
    start: Literal["poses", "residuals", "both"] = "both"
    """Whose principal components the latent points begin with."""
    momentum: float | None = 0.5
    """Weight of velocities beside angles, both at variance 1; None for the angles of two frames, unscaled."""
    expected: bool = True
    """Whether the variance of the latent point enters mean and variance of the prediction."""
    iterations: int = 100
    """Largest number of steps."""
    judged: int = 400
    """At most so many frames, spread evenly, make up the model: its cost grows with their cube."""
    name: str = "gplvm"
    """Name in tables and options."""
    progress: Progress = silent
    """Told about every step."""

    @classmethod
    def paper(cls) -> LatentLearner:
        """Return the setting of the paper.

        Returns
        -------
        LatentLearner
            Four latent dimensions, the product of the likelihoods, a start from the poses of two frames, 100
            iterations, and the output variance alone.
        """
        return cls(dim=4, balanced=False, start="poses", momentum=None, expected=False, name="gplvm-paper")

    def fit(self, training: Training) -> LatentPredictor:
        """Learn from T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        LatentPredictor
            One mixture for all regions.

        Raises
        ------
        ValueError
            If there is less than one latent dimension.
        """
        if self.dim < 1:
            raise ValueError(f"dim must be 1 or more, got {self.dim}")
        T = len(training.inputs)
        frames = spread_frames(T, self.judged)
        inputs = rows_of(training.inputs, frames)
        features, Y, groups = self._poses(inputs)
        poses, moved = unit_gram(centred_gram(Y))
        residuals, variance = unit_gram(
            _centred(training.gram)[np.ix_(frames, frames)] / training.sizes.sum()
        )
        basis = TrainingFrames(frames, T, variance, self._notes(T, len(frames)))
        if len(frames) < FEWEST or not moved or not variance:
            return LatentPredictor(features, basis, None, None, self.expected)
        with one_blas_thread():
            fit = self._train(poses, residuals, inputs.chains, (Y.shape[1], float(training.sizes.sum())))
            back = fit_back_map(Y, groups, fit.X)
            process = LatentProcess(fit.X, fit.detail, residuals)
        return LatentPredictor(features, basis, back, process, self.expected)

    def _poses(self, inputs: Inputs) -> tuple[Features | TwoFrames | Scaled, FloatArray, IntArray]:
        """Columns that stand for a pose and the group of each."""
        if self.momentum is None:
            two = TwoFrames()
            Y = two(inputs)
            return two, Y, np.zeros(Y.shape[1], dtype=np.int64)
        scaled = Scaled(Features.of(inputs), self.momentum)
        return scaled, scaled(inputs), scaled.groups(inputs)

    def _train(
        self, poses: FloatArray, residuals: FloatArray, chains: IntArray, sizes: tuple[float, float]
    ) -> LatentFit:
        q = self._lowered(len(chains))
        begin = {"poses": poses, "residuals": residuals, "both": poses + residuals}[self.start]
        scales = (1.0, 1.0, 1.0 / q) if self.balanced else (*sizes, float(q))
        return train_latent(
            poses,
            residuals,
            latent_start(begin, q),
            chains,
            scales=scales,
            iterations=self.iterations,
            progress=self.progress,
        )

    def _lowered(self, frames: int) -> int:
        return min(self.dim, max(frames - 1, 1))

    def _notes(self, T: int, frames: int) -> tuple[str, ...]:
        notes: list[str] = []
        if frames < FEWEST:
            notes.append(f"{self.name}: {T} frames are too few to learn from, the mean is predicted")
        elif self._lowered(frames) < self.dim:
            notes.append(f"{self.name}: {T} frames hold no {self.dim} latent dimensions, {T - 1} are used")
        if frames < T:
            notes.append(f"{self.name}: {frames} of {T} frames, spread evenly, are learned from")
        return tuple(notes)


def _centred(gram: FloatArray) -> FloatArray:
    rows = gram - gram.mean(axis=0)
    return rows - rows.mean(axis=1, keepdims=True)


def rows_of(inputs: Inputs, frames: IntArray) -> Inputs:
    """Take frames of each clip as if they followed one another.

    Parameters
    ----------
    inputs : Inputs
        T frames.
    frames : (k,) int
        Sorted frames.

    Returns
    -------
    Inputs
        Those frames, in the chains they were in.
    """
    return Inputs(
        inputs.angles[frames],
        inputs.velocity[frames],
        inputs.extra[frames],
        inputs.chains[frames],
        inputs.joints,
    )
