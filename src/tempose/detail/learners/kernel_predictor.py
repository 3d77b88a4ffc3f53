"""Gaussian processes that share inputs and observations, one for each region, queried together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tempose.detail.learners.features import Features, TwoFrames
from tempose.detail.training import Inputs, Mixture
from tempose.regression import Kernel, ProcessBank, choose_inducing
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class KernelPredictor:
    """A Gaussian process for each of R regions."""

    features: Features | TwoFrames
    """Columns of the inputs."""
    kernels: Sequence[Kernel | None]
    """R or 1, for outputs of variance 1; None predicts the mean."""
    X: FloatArray
    """(T, P) columns of the training."""
    spreads: FloatArray
    """(R or 1,) variance of one coordinate over the training, times what blocks left out say that predicted
    variances lack, metres squared."""
    inducing: int = 0
    """At most so many frames are compared with; 0 for all."""
    vague: FloatArray | None = None
    """(R or 1, T) noise of frames whose past is not known whole, added to that of the kernels."""
    bank: ProcessBank | None = field(init=False)
    """Of the kernels that there are, made from the rest; None where there are none."""

    def __post_init__(self) -> None:
        alive = [r for r, kernel in enumerate(self.kernels) if kernel is not None]
        object.__setattr__(self, "bank", self._bank(alive) if alive else None)

    def _bank(self, alive: list[int]) -> ProcessBank:
        kernels = [kernel for kernel in self.kernels if kernel is not None]
        vague = None if self.vague is None else self.vague[alive]
        if not 0 < self.inducing < len(self.X):
            return ProcessBank(kernels, self.X, None, vague)
        smooth, linear = (
            float(np.mean([getattr(k, part) for k in kernels])) for part in ("smooth", "linear")
        )
        precision = np.exp(np.mean([np.log(k.precision) for k in kernels], axis=0))
        usual = Kernel(smooth, linear, kernels[0].noise, precision, kernels[0].groups)
        return ProcessBank(kernels, self.X, choose_inducing(usual, self.X, self.inducing), vague)

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the residuals of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            Weights of the training frames, variances.
        """
        R, Q, T = len(self.kernels), len(inputs), len(self.X)
        alive = [r for r in range(R) if self.kernels[r] is not None]
        weights, variance = np.zeros((R, Q, T)), np.ones((R, Q))
        if self.bank is not None:
            weights[alive], variance[alive] = self.bank.query(self.features(inputs))
        return Mixture(weights, variance.T * self.spreads)


def unit_grams(grams: FloatArray, sizes: FloatArray, some: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centre Gram matrices, scale them to outputs of variance 1 and keep some frames.

    Parameters
    ----------
    grams : (R, T, T) float
        Inner products of raw residuals, metres squared.
    sizes : (R,) float
        Coordinates of each region.
    some : (k,) int
        Frames kept.

    Returns
    -------
    grams : (R, k, k) ndarray
        Less the mean over all T frames, which then have trace T; zero where there is nothing to learn.
    spreads : (R,) ndarray
        Variance of one coordinate over all frames, metres squared.
    """
    T = grams.shape[1]
    raw = np.trace(grams, axis1=1, axis2=2)
    rows = grams.mean(axis=2)
    mean = rows.mean(axis=1)
    traces = raw - T * mean
    # rounding of inner products is no residual
    alive = traces > 1e-12 * max(float(raw.max(initial=0.0)), 1e-300)
    spreads = np.where(alive, traces, 0.0) / (T * np.maximum(sizes, 1e-12))
    near = rows[:, some]
    S = grams[:, some[:, None], some] - near[:, :, None] - near[:, None] + mean[:, None, None]
    return S * np.where(alive, T / np.where(alive, traces, 1.0), 0.0)[:, None, None], spreads


def spread_frames(T: int, most: int) -> IntArray:
    """Choose frames evenly.

    Parameters
    ----------
    T : int
        Number of frames.
    most : int
        At most so many are chosen.

    Returns
    -------
    (min(T, most),) ndarray
        Sorted frames.
    """
    return np.unique(np.linspace(0, T - 1, min(T, most)).round().astype(np.int64))
