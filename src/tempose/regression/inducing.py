"""Gaussian process regression from thousands of observations through a few hundred inducing inputs."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular

from tempose.regression.kernel import Kernel
from tempose.typing import FloatArray, IntArray

_JITTER = 1e-10
"""Added to the covariance of the inducing inputs, as part of its mean diagonal: it can then be factorised."""


class InducingProcess:
    """A kernel conditioned on T inputs, seen through m of them; a query costs m^2, not T^2.

    Parameters
    ----------
    kernel : Kernel
        With noise above zero.
    X : (T, P) float
        Inputs of the observations.
    inducing : (m, P) float
        Inducing inputs, for instance some rows of `X`. When all rows are taken the process is the dense one.
    vague : (T,) float, optional
        Noise of single observations, added to that of the kernel.

    Notes
    -----
    Mean and variance are those of the deterministic training conditional, eqs. (20) of [1]_, with the exact
    variance of the prior.

    References
    ----------
    .. [1] Quinonero-Candela and Rasmussen, "A unifying view of sparse approximate Gaussian process
       regression", Journal of Machine Learning Research 6, 2005.
    """

    def __init__(
        self, kernel: Kernel, X: FloatArray, inducing: FloatArray, vague: FloatArray | None = None
    ) -> None:
        self.kernel = kernel
        self.inducing: FloatArray = np.asarray(inducing, dtype=np.float64)
        m = len(self.inducing)
        K = kernel(self.inducing, self.inducing)
        K.flat[:: m + 1] += _JITTER * np.trace(K) / m
        self._lower: FloatArray = np.linalg.cholesky(K)
        # whitened by the inducing covariance, all the rest is well conditioned
        seen = solve_triangular(self._lower, kernel(self.inducing, X), lower=True)
        self._seen: FloatArray = seen / (kernel.noise if vague is None else kernel.noise + vague)
        inner = self._seen @ seen.T
        inner.flat[:: m + 1] += 1.0
        self._factor = cho_factor(inner, lower=True)

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
        return cho_solve(self._factor, self._whitened(X)).T @ self._seen

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
        V = self._whitened(X)
        unseen = self.kernel.diagonal(X) - np.square(V).sum(axis=0)
        known = np.square(solve_triangular(self._factor[0], V, lower=True)).sum(axis=0)
        return np.maximum(unseen, 0.0) + known + self.kernel.noise

    def solvers(self) -> tuple[FloatArray, FloatArray]:
        """Return what covariances with the inducing inputs are multiplied by.

        Returns
        -------
        weights : (m, T) ndarray
            ``weights(X) = kernel(X, self.inducing) @ weights``.
        known : (m, m) ndarray
            What ``k(x, inducing) @ known @ k(inducing, x)`` takes from the variance of the prior.
        """
        unwhiten = solve_triangular(self._lower, np.eye(len(self._lower)), lower=True)
        weights = unwhiten.T @ cho_solve(self._factor, self._seen)
        inner = cho_solve(self._factor, unwhiten)
        return weights, unwhiten.T @ (unwhiten - inner)

    def _whitened(self, X: FloatArray) -> FloatArray:
        return solve_triangular(self._lower, self.kernel(self.inducing, X), lower=True)


def choose_inducing(kernel: Kernel, X: FloatArray, m: int) -> IntArray:
    """Choose inputs that stand for the others: each the one known least from those before it.

    Parameters
    ----------
    kernel : Kernel
        Which inputs are alike.
    X : (T, P) float
        Inputs.
    m : int
        At most so many; fewer where they already tell all others to 1e-9 of the largest variance.

    Returns
    -------
    (<= m,) ndarray
        Sorted rows of `X`.

    Notes
    -----
    The pivots of an incomplete Cholesky factorisation of the covariance.
    """
    left = np.array(kernel.diagonal(X))
    least = 1e-9 * float(left.max(initial=0.0))
    L = np.zeros((min(m, len(X)), len(X)))
    chosen: list[int] = []
    for i in range(len(L)):
        pivot = int(left.argmax())
        if left[pivot] <= least:
            break
        row = kernel(X[pivot : pivot + 1], X)[0] - L[:i, pivot] @ L[:i]
        L[i] = row / np.sqrt(left[pivot])
        left -= L[i] ** 2
        left[pivot] = -np.inf
        chosen.append(pivot)
    return np.sort(np.array(chosen, dtype=np.int64))
