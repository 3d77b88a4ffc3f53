"""The shared latent model as a learner: exactly as in the paper, and in its better setting."""

from __future__ import annotations

from dataclasses import dataclass, replace
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
    widen_variances,
)
from tempose.detail.learners.features import TwoFrames
from tempose.detail.learners.kernel_predictor import spread_frames
from tempose.detail.learners.latent_predictor import LatentPredictor, Poses, TrainingFrames
from tempose.detail.learners.scaled_poses import ScaledPoses
from tempose.detail.training import Inputs, Training
from tempose.regression import one_blas_thread
from tempose.typing import FloatArray, IntArray, Progress, silent

FEWEST = 3
"""Frames below which there is nothing to learn: the mean is predicted."""
_STILL = 1e-14
"""Variance of angles, square radians, or of residuals, as part of their mean square, that is rounding."""


@dataclass(frozen=True)
class LatentLearner:
    """Shared Gaussian process latent variable model with dynamics.

    Poses and residuals are Gaussian processes over one latent point a frame, and every latent point is one
    over the point before. The default differs from the paper, each time for a measured reason: 16 latent
    dimensions for 4, likelihoods divided by their dimensions so that 30 000 vertex coordinates do not drown
    the rest, a start from poses and residuals together, joints that count by how much residuals depend on
    them, and a prediction that knows how unsure the latent point is. `paper` has the paper's setting.

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
    scaled: bool = True
    """Whether every joint counts by how much residuals depend on it; otherwise the angles of two frames are
    taken as they are."""
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
        return cls(dim=4, balanced=False, start="poses", scaled=False, expected=False, name="gplvm-paper")

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
        residuals, variance = unit_gram(training.centred_gram[np.ix_(frames, frames)] / training.sizes.sum())
        residuals = _short(residuals)
        basis = TrainingFrames(frames, T, variance, self._notes(T, len(frames)))
        _, moved = unit_gram(centred_gram(TwoFrames()(inputs)))
        still = moved <= _STILL or variance * T * training.sizes.sum() <= _STILL * np.trace(training.gram)
        if len(frames) < FEWEST or still:
            return LatentPredictor(TwoFrames(), basis, None, None, self.expected)
        with one_blas_thread():
            features, Y, groups = self._poses(inputs, residuals)
            Y = _short(Y)
            poses, _ = unit_gram(centred_gram(Y))
            fit = self._train(poses, residuals, inputs.chains, (Y.shape[1], float(training.sizes.sum())))
            back = fit_back_map(Y, groups, fit.X)
            process = LatentProcess(fit.X, fit.detail, residuals)
            if self.expected:
                wider = widen_variances(back, process, inputs.chains)
                back = replace(back, widening=wider.points)
                basis = replace(basis, variance=wider.residuals * variance)
        return LatentPredictor(features, basis, back, process, self.expected)

    def _poses(self, inputs: Inputs, residuals: FloatArray) -> tuple[Poses, FloatArray, IntArray]:
        """Columns that stand for a pose and the group of each."""
        if not self.scaled:
            two = TwoFrames()
            Y = two(inputs)
            return two, Y, np.zeros(Y.shape[1], dtype=np.int64)
        columns = ScaledPoses.of(inputs, residuals)
        return columns, columns(inputs), columns.blocks(inputs)

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


def _short(values: FloatArray) -> FloatArray:
    """Round to float32: what a file keeps of a model is then half as long."""
    return values.astype(np.float32).astype(np.float64)


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
    return replace(inputs.take(frames), chains=inputs.chains[frames])
