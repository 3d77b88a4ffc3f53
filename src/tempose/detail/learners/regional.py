"""A Gaussian process for each region of the body, with length scales of its own for every joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.calibration import variance_factor
from tempose.detail.learners.features import Features
from tempose.detail.learners.kernel_predictor import KernelPredictor, spread_frames, unit_grams
from tempose.detail.learners.memory import frame_ages, lags_at
from tempose.detail.training import Inputs, Training
from tempose.regression import GroupDistances, Kernel, fit_kernel, one_blas_thread
from tempose.typing import FloatArray, IntArray, Progress, silent


@dataclass(frozen=True)
class RegionalGaussianProcess:
    """Gaussian processes on angles and velocities; which joints matter is found for every region.

    All regions begin from the most likely kernel of the whole body that knows one scale for angles and one
    for velocities; a prior keeps their scales near it unless the residuals say otherwise.
    """

    lags: tuple[int, ...] = (0, 2, 4, 6, 9, 12)
    """Thirtieths of a second back at which velocities are seen, ascending: cloth that swings remembers that
    much. At other rates the nearest frames are taken."""
    prior: float = 0.5
    """Weight of the squared distance of logarithmic scales from those of the whole body."""
    iterations: int = 8
    """Largest number of steps for each region; more do not predict better."""
    judged: int = 120
    """At most so many frames judge kernels."""
    inducing: int = 400
    """At most so many frames are compared with at a query; 0 for all."""
    name: str = "regional-gp"
    """Name in tables and options."""
    progress: Progress = silent
    """Told about every region."""

    def fit(self, training: Training) -> KernelPredictor:
        """Learn from T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        KernelPredictor
            One mixture for each region.
        """
        inputs = training.inputs
        features = Features.of(inputs, lags_at(self.lags, inputs.fps))
        X, groups, blocks = features(inputs), features.groups(inputs), features.blocks(inputs)
        known = _known_past(inputs, features.lags[-1])
        some = known[spread_frames(len(known), self.judged)]
        S, spreads = unit_grams(training.grams, training.sizes, some)
        kernels: list[Kernel | None] = [None] * len(S)
        if len(X) < 3 or not spreads.any():
            return KernelPredictor(features, kernels, X, spreads)
        seen = X[some]
        whole = np.einsum("r,rij->ij", spreads * training.sizes, S)
        with one_blas_thread():
            start = _whole_body(seen, groups, blocks, whole * len(some) / np.trace(whole))
            unknown, vague = features.unknown(inputs), np.zeros((len(S), len(X)))
            factors, distances = np.ones(len(S)), GroupDistances(seen, groups)
            for r in np.flatnonzero(spreads):
                fit = fit_kernel(
                    distances, groups, S[r], starts=[start], prior=self.prior, iterations=self.iterations
                )
                kernels[r] = fit.kernel
                vague[r] = _vagueness(fit.kernel, unknown)
                factors[r] = variance_factor(fit.kernel, seen, S[r], inputs.chains[some])
                self.progress(int(r) + 1, len(S), "regions")
        return KernelPredictor(features, kernels, X, factors * spreads, self.inducing, vague)


def _known_past(inputs: Inputs, lag: int) -> IntArray:
    """Frames whose earlier velocities are all known, unless too few would be left."""
    known = np.flatnonzero(frame_ages(inputs.chains) >= lag)
    return known if len(known) >= max(3, len(inputs) // 2) else np.arange(len(inputs))


def _whole_body(X: FloatArray, groups: IntArray, blocks: IntArray, S: FloatArray) -> Kernel:
    """Most likely kernel with one scale a block, given to all groups of the block."""
    columns = np.unique(blocks, return_inverse=True)[1]
    kernel = fit_kernel(X, columns, S, iterations=25).kernel
    block_of = np.zeros(groups.max() + 1, dtype=np.int64)
    block_of[groups] = columns
    return Kernel(kernel.smooth, kernel.linear, kernel.noise, kernel.precision[block_of], groups)


def _vagueness(kernel: Kernel, unknown: FloatArray) -> FloatArray:
    """Variance of outputs between inputs so far apart as (T, G) squared distances have it."""
    apart = unknown @ kernel.precision
    return kernel.smooth * (1.0 - np.exp(-0.5 * apart)) + kernel.linear * apart
