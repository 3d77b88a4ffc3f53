"""From a pose to its latent point, with how sure that is."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose.regression import GaussianProcess, Kernel, fit_kernel
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class BackMap:
    """Gaussian process regression from poses to latent points."""

    kernel: Kernel
    """For coordinates of variance 1."""
    Y: FloatArray
    """(T, P) poses of the training, less their mean."""
    X: FloatArray
    """(T, q) their latent points."""
    mean: FloatArray
    """(P,) mean pose."""
    widening: float = 1.0
    """Factor on the variance, see `widen_variances`."""
    process: GaussianProcess = field(init=False)
    """Made from the rest."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "process", GaussianProcess(self.kernel, self.Y))

    def __call__(self, Y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Place poses in the latent space.

        Parameters
        ----------
        Y : (Q, P) float
            Poses.

        Returns
        -------
        points : (Q, q) ndarray
            Most likely latent points.
        variance : (Q,) ndarray
            Variance of each of their coordinates, without the noise of the training.
        """
        Y = Y - self.mean
        centre = self.X.mean(axis=0)
        points = centre + self.process.weights(Y) @ (self.X - centre)
        spread = float(np.mean((self.X - centre) ** 2))
        unsure = np.maximum(self.process.variance(Y) - self.kernel.noise, 0.0)
        return points, self.widening * spread * unsure


def fit_back_map(
    Y: FloatArray, groups: IntArray, X: FloatArray, iterations: int = 30, judged: int = 160
) -> BackMap:
    """Learn where in the latent space a pose lies.

    Parameters
    ----------
    Y : (T, P) float
        Poses.
    groups : (P,) int
        Group of every column; the columns of a group share a length scale.
    X : (T, q) float
        Latent points.
    iterations : int, default 30
        Largest number of steps from each start.
    judged : int, default 160
        At most so many frames, spread evenly, judge kernels.

    Returns
    -------
    BackMap
        Regression by the most likely kernel.
    """
    mean = Y.mean(axis=0)
    centred = X - X.mean(axis=0)
    some = np.unique(np.linspace(0, len(X) - 1, min(len(X), judged)).round().astype(np.int64))
    seen = centred[some]
    S = seen @ seen.T / max(float(np.mean(seen**2)) * X.shape[1], 1e-300)
    kernel = fit_kernel((Y - mean)[some], groups, S, iterations=iterations).kernel
    return BackMap(kernel, Y - mean, X, mean)
