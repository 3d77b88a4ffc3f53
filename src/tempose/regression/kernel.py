"""Covariance of a Gaussian process: a smooth part, a linear part, noise; groups of inputs share a scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Kernel:
    """How alike the outputs of two inputs are.

    With ``d^2 = sum_g precision_g |x_g - x'_g|^2`` over the groups g of input columns,
    ``k(x, x') = smooth exp(-d^2 / 2) + linear sum_g precision_g <x_g, x'_g>``, and `noise` on the diagonal.
    """

    smooth: float
    """Variance of the smooth part."""
    linear: float
    """Variance of the linear part."""
    noise: float
    """Variance of what no input tells."""
    precision: FloatArray
    """(G,) one over the squared length scale of every group."""
    groups: IntArray
    """(P,) group of every column of the input."""

    def __call__(self, X1: FloatArray, X2: FloatArray) -> FloatArray:
        """Compare inputs, without noise.

        Parameters
        ----------
        X1 : (n1, P) float
            Inputs.
        X2 : (n2, P) float
            Inputs.

        Returns
        -------
        (n1, n2) ndarray
            Covariances.
        """
        root = np.sqrt(self.precision[self.groups])
        A, B = X1 * root, X2 * root
        products = A @ B.T
        squares = np.square(A).sum(axis=1)[:, None] + np.square(B).sum(axis=1)
        distances = np.maximum(squares - 2 * products, 0.0)
        return self.smooth * np.exp(-0.5 * distances) + self.linear * products

    def diagonal(self, X: FloatArray) -> FloatArray:
        """Variance of the output at inputs, without noise.

        Parameters
        ----------
        X : (n, P) float
            Inputs.

        Returns
        -------
        (n,) ndarray
            Variances.
        """
        return self.smooth + self.linear * (np.square(X) @ self.precision[self.groups])

    @property
    def logarithms(self) -> FloatArray:
        """(3 + G,) of smooth, linear, noise and the precisions: what is optimised."""
        return np.log([self.smooth, self.linear, self.noise, *self.precision])

    @staticmethod
    def from_logarithms(logarithms: FloatArray, groups: IntArray) -> Kernel:
        """Make a kernel from what is optimised.

        Parameters
        ----------
        logarithms : (3 + G,) float
            Of smooth, linear, noise and the precisions.
        groups : (P,) int
            Group of every column of the input.

        Returns
        -------
        Kernel
            That kernel.
        """
        smooth, linear, noise, *precision = np.exp(logarithms)
        return Kernel(float(smooth), float(linear), float(noise), np.array(precision), np.asarray(groups))
