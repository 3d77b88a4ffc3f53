"""Gaussian process regression: predictions as mixtures of what was observed."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular

from tempose.regression.kernel import Kernel
from tempose.typing import FloatArray


class GaussianProcess:
    """A kernel conditioned on T inputs; the outputs enter only when a prediction is made.

    Parameters
    ----------
    kernel : Kernel
        With noise above zero.
    X : (T, P) float
        Inputs of the observations.
    vague : (T,) float, optional
        Noise of single observations, added to that of the kernel.

    Raises
    ------
    ValueError
        If the covariance of the inputs is singular.
    """

    def __init__(self, kernel: Kernel, X: FloatArray, vague: FloatArray | None = None) -> None:
        self.kernel = kernel
        self.X: FloatArray = np.asarray(X, dtype=np.float64)
        K = kernel(self.X, self.X)
        K.flat[:: len(K) + 1] += kernel.noise if vague is None else kernel.noise + vague
        try:
            self._factor = cho_factor(K, lower=True)
        except np.linalg.LinAlgError:
            raise ValueError(
                f"covariance of {len(K)} inputs is singular with noise {kernel.noise:.3g}: raise the noise"
            ) from None

    def weights(self, X: FloatArray) -> FloatArray:
        """Say how a prediction is mixed from the observations.

        Parameters
        ----------
        X : (Q, P) float
            Inputs.

        Returns
        -------
        (Q, T) ndarray
            The predicted output is ``weights @ Y`` for centred outputs Y (T, d).
        """
        return cho_solve(self._factor, self.kernel(self.X, X)).T

    def inverse(self) -> FloatArray:
        """Return the inverse covariance of the observations.

        Returns
        -------
        (T, T) ndarray
            Symmetric: ``weights(X) = kernel(X, self.X) @ inverse()``.
        """
        inverse = cho_solve(self._factor, np.eye(len(self.X)))
        return 0.5 * (inverse + inverse.T)

    def variance(self, X: FloatArray) -> FloatArray:
        """Variance of a noisy observation of one output, given the T others.

        Parameters
        ----------
        X : (Q, P) float
            Inputs.

        Returns
        -------
        (Q,) ndarray
            At least the noise.
        """
        V = solve_triangular(self._factor[0], self.kernel(self.X, X), lower=True)
        left = self.kernel.diagonal(X) - np.square(V).sum(axis=0)
        return np.maximum(left, 0.0) + self.kernel.noise
