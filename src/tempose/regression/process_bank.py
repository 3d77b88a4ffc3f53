"""Several Gaussian processes on the same inputs, queried together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.regression.gaussian_process import GaussianProcess
from tempose.regression.inducing import InducingProcess
from tempose.regression.kernel import Kernel
from tempose.typing import FloatArray, IntArray


class ProcessBank:
    """R kernels conditioned on the same T inputs; a query is two matrix products for all of them.

    Parameters
    ----------
    kernels : sequence of Kernel
        R of them, with the same groups of columns.
    X : (T, P) float
        Inputs of the observations.
    inducing : (m,) int, optional
        Rows of `X` through which the others are seen; all where left out.
    vague : (R, T) float, optional
        Noise of single observations, added to that of each kernel.
    """

    def __init__(
        self,
        kernels: Sequence[Kernel],
        X: FloatArray,
        inducing: IntArray | None = None,
        vague: FloatArray | None = None,
    ) -> None:
        self._smooth, self._linear, self._noise = (
            np.array([getattr(k, name) for k in kernels])[:, None, None]
            for name in ("smooth", "linear", "noise")
        )
        self._precision: FloatArray = np.array([k.precision[k.groups] for k in kernels])
        self._centre: FloatArray = X.mean(axis=0)
        self._compared: FloatArray = (X if inducing is None else X[inducing]) - self._centre
        self._squares: FloatArray = self._precision @ np.square(self._compared).T
        self._offset: FloatArray = self._precision * self._centre
        each = [None] * len(kernels) if vague is None else vague
        made = [_solver(kernel, X, inducing, extra) for kernel, extra in zip(kernels, each)]
        self._solver: FloatArray = np.array([solver for solver, _ in made])
        self._known: FloatArray = (
            np.array([known for _, known in made]) if inducing is not None else self._solver
        )

    def query(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Say how predictions are mixed from the observations, and how sure they are.

        Parameters
        ----------
        X : (Q, P) float
            Inputs.

        Returns
        -------
        weights : (R, Q, T) ndarray
            As `GaussianProcess.weights`.
        variance : (R, Q) ndarray
            As `GaussianProcess.variance`.
        """
        alike, prior = self._similarity(X)
        weights = alike @ self._solver
        seen = weights if self._known is self._solver else alike @ self._known
        left = prior - np.einsum("rqm,rqm->rq", alike, seen)
        return weights, np.maximum(left, 0.0) + self._noise[:, :, 0]

    def solve(self, Y: FloatArray) -> FloatArray:
        """Prepare outputs for `means`.

        Parameters
        ----------
        Y : (T, K) float
            Centred outputs of the observations.

        Returns
        -------
        (R, m, K) ndarray
            What similarities are multiplied by.
        """
        return self._solver @ Y

    def means(self, X: FloatArray, solved: FloatArray) -> FloatArray:
        """Predict few outputs, without their variance: much quicker than to mix them from all observations.

        Parameters
        ----------
        X : (Q, P) float
            Inputs.
        solved : (R, m, K) float
            From `solve`.

        Returns
        -------
        (R, Q, K) ndarray
            Predicted outputs.
        """
        return self._similarity(X)[0] @ solved

    def _similarity(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Covariances (R, Q, m) with what is compared, and prior variances (R, Q), without noise."""
        Z = X - self._centre
        R, Q = len(self._precision), len(Z)
        scaled = (self._precision[:, None] * Z).reshape(R * Q, -1)
        products = (scaled @ self._compared.T).reshape(R, Q, -1)
        squares = self._precision @ np.square(Z).T
        apart = np.maximum(squares[:, :, None] + self._squares[:, None] - 2 * products, 0.0)
        # the linear part is about the origin of X, products are about its centre
        shift, other = Z @ self._offset.T, self._compared @ self._offset.T
        middle = (self._offset @ self._centre)[:, None]
        products += shift.T[:, :, None] + (other.T + middle)[:, None]
        whole = squares + 2 * shift.T + middle
        alike = self._smooth * np.exp(-0.5 * apart) + self._linear * products
        return alike, self._smooth[:, :, 0] + self._linear[:, :, 0] * whole


def _solver(
    kernel: Kernel, X: FloatArray, inducing: IntArray | None, vague: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    """Return what similarities are multiplied by: to give weights (m, T), to give what is known (m, m)."""
    if inducing is None:
        inverse = GaussianProcess(kernel, X, vague).inverse()
        return inverse, inverse
    return InducingProcess(kernel, X, X[inducing], vague).solvers()
