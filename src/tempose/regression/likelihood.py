"""Likelihood of a kernel given inputs and the inner products of the outputs, and its gradient."""

from __future__ import annotations

import numpy as np
from scipy.linalg import get_lapack_funcs

from tempose.regression.group_distances import GroupDistances
from tempose.regression.kernel import Kernel
from tempose.typing import FloatArray

_FACTORISE, _INVERT = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)


class GramLikelihood:
    """Evidence for kernels from T observations, of however many outputs.

    Outputs enter through ``S = Y Y^T / (number of outputs)`` only, so that a step costs the same for one
    output as for a hundred thousand.

    Parameters
    ----------
    inputs : GroupDistances
        Of T inputs in G groups.
    S : (T, T) float
        Mean over the outputs of their outer products.

    Notes
    -----
    For outputs that are independent given the kernel, each with covariance K, minus the mean log likelihood
    is ``(log |K| + tr(K^-1 S)) / 2`` plus a constant, eq. (1) of [1]_; its derivative by K is
    ``(K^-1 - K^-1 S K^-1) / 2``.

    References
    ----------
    .. [1] Lawrence, "Gaussian process latent variable models for visualisation of high dimensional data",
       NIPS 2003.
    """

    def __init__(self, inputs: GroupDistances, S: FloatArray) -> None:
        self.inputs = inputs
        self._S: FloatArray = np.asarray(S, dtype=np.float64)
        self._pairs = inputs.pairs

    def __call__(self, logarithms: FloatArray) -> tuple[float, FloatArray]:
        """Judge a kernel.

        Parameters
        ----------
        logarithms : (3 + G,) float
            Of the kernel, see `Kernel.logarithms`.

        Returns
        -------
        value : float
            Minus the log likelihood of one output, without its constant; infinite where K cannot be
            factorised.
        gradient : (3 + G,) ndarray
            Its derivative by the logarithms.
        """
        kernel = Kernel.from_logarithms(logarithms, self.inputs.groups)
        rows, columns = self.inputs.rows, self.inputs.columns
        squares = kernel.precision @ self.inputs.squares
        apart = kernel.precision @ self.inputs.distances
        smooth = kernel.smooth * np.exp(-0.5 * apart)
        linear = 0.5 * kernel.linear * (squares[rows] + squares[columns] - apart)
        K = np.diag(kernel.smooth + kernel.linear * squares + kernel.noise)
        K.ravel()[self._pairs] = smooth + linear
        inverse, log_determinant = _inverse(K)
        if inverse is None:
            return np.inf, np.zeros(len(logarithms))
        inner = inverse @ self._S
        value = 0.5 * float(log_determinant + np.trace(inner))
        slope = 0.5 * (inverse - inner @ inverse)
        return value, self._gradient(kernel, slope, smooth)

    def _gradient(self, kernel: Kernel, slope: FloatArray, smooth: FloatArray) -> FloatArray:
        """Derive by the logarithms, from the derivative by K; a pair stands for two entries."""
        diagonal, pairs = np.diagonal(slope), 2 * slope.ravel()[self._pairs]
        by_smooth = pairs * smooth
        near, far = (self.inputs.distances @ np.column_stack([by_smooth, pairs])).T
        products = self.inputs.squares @ slope.sum(axis=0) - 0.5 * far
        by_precision = kernel.linear * products - 0.5 * near
        by_linear = kernel.linear * float(kernel.precision @ products)
        trace = float(diagonal.sum())
        amounts = [by_smooth.sum() + kernel.smooth * trace, by_linear, kernel.noise * trace]
        return np.concatenate([amounts, kernel.precision * by_precision])


def _inverse(K: FloatArray) -> tuple[FloatArray | None, float]:
    """Inverse and log determinant of a matrix given by its lower triangle, None where it is not positive."""
    lower, failed = _FACTORISE(K, lower=1, clean=1)
    if failed:
        return None, np.inf
    inverse = _INVERT(lower, lower=1)[0]
    return inverse + np.tril(inverse, -1).T, 2 * float(np.log(np.diagonal(lower)).sum())
