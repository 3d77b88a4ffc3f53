"""From an uncertain latent point to residuals and how far they may be off."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from tempose.detail.gplvm._kernels import expected_squares
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class LatentProcess:
    """Gaussian process from latent points to residuals, asked at points known up to a variance.

    For ``x* ~ N(m, v I)`` the kernel ``a exp(-g |x* - x_i|^2 / 2)`` has the mean
    ``a (1 + g v)^(-q/2) exp(-g |m - x_i|^2 / (2 (1 + g v)))`` [1]_: where the point is unsure, the prediction
    goes to the mean residual.

    References
    ----------
    .. [1] Girard, Rasmussen, Quinonero-Candela and Murray-Smith, "Gaussian process priors with uncertain
       inputs", NIPS 2002.
    """

    X: FloatArray
    """(T, q) latent points of the training."""
    hyper: FloatArray
    """(3,) variance a, rate g and noise s for residuals of variance 1."""
    gram: FloatArray
    """(T, T) inner products of the centred residuals, trace T."""
    inverse: FloatArray = field(init=False)
    """(T, T) inverse of the covariance; made from the rest."""
    wanting: FloatArray = field(init=False)
    """(T, T) inverse less what the residuals explain of it; made from the rest."""

    def __post_init__(self) -> None:
        a, g, s = self.hyper
        K = a * np.exp(-0.5 * g * squared_distances(self.X, self.X))
        K.flat[:: len(K) + 1] += s
        inverse = cho_solve(cho_factor(K, lower=True), np.eye(len(K)))
        object.__setattr__(self, "inverse", inverse)
        object.__setattr__(self, "wanting", inverse - inverse @ self.gram @ inverse)

    def weights(self, points: FloatArray, variance: FloatArray) -> FloatArray:
        """Say how the expected residual is mixed from those of the training.

        Parameters
        ----------
        points : (Q, q) float
            Latent points.
        variance : (Q,) float
            Of each of their coordinates.

        Returns
        -------
        (Q, T) ndarray
            Weights of the centred residuals.
        """
        a, g, _ = self.hyper
        wide = 1.0 + g * variance
        squares = squared_distances(points, self.X)
        height = a * wide ** (-0.5 * self.X.shape[1])
        return (height[:, None] * np.exp(-0.5 * g * squares / wide[:, None])) @ self.inverse

    def variance(self, points: FloatArray, variance: FloatArray) -> FloatArray:
        """Variance of one coordinate of a residual of variance 1: that of the process and of the point.

        Parameters
        ----------
        points : (Q, q) float
            Latent points.
        variance : (Q,) float
            Of each of their coordinates.

        Returns
        -------
        (Q,) ndarray
            At least the noise.
        """
        a, g, s = self.hyper
        W = self.weights(points, variance)
        mean = np.einsum("qt,qt->q", W @ self.gram, W)
        squares = squared_distances(points, self.X)
        apart = squared_distances(self.X, self.X)
        lost = expected_squares(self.wanting, apart, squares, np.asarray(variance), a, g, self.X.shape[1])
        return np.maximum(a - lost - mean, 0.0) + s


def squared_distances(A: FloatArray, B: FloatArray) -> FloatArray:
    """Compare two sets of points.

    Parameters
    ----------
    A : (n, q) float
        Points.
    B : (m, q) float
        Points.

    Returns
    -------
    (n, m) ndarray
        Squared distances.
    """
    squares = np.square(A).sum(axis=1)[:, None] + np.square(B).sum(axis=1)
    return np.maximum(squares - 2 * A @ B.T, 0.0)
