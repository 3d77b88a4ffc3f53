"""The negative log likelihood of one Gaussian process over latent points, with its slopes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import get_blas_funcs, get_lapack_funcs

from tempose.detail.gplvm._kernels import fill_covariance, fill_slopes
from tempose.typing import FloatArray

_MULTIPLY, _SQUARE = get_blas_funcs(("symm", "syrk"), dtype=np.float64)
_FACTORISE, _INVERT = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)


class Slopes(NamedTuple):
    """Value of a likelihood and its slopes."""

    value: float
    """Negative log likelihood, without the constant; infinite where the covariance is singular."""
    hyper: FloatArray
    """(3,) or (4,) slopes in the logarithms of variance, rate, noise and linear variance."""
    points: FloatArray
    """(T, q) slope in the points of the kernel."""
    outputs: FloatArray
    """(T, r) slope in the outputs."""


class LatentLikelihood:
    """Minus log of ``N(Z; 0, K(X))`` a column of outputs, for any points and outputs of one size.

    ``K = a exp(-g |x - x'|^2 / 2) + c x . x' + s [x = x']``. Outputs matter up to a rotation of their
    columns: any factor of ``Y Y^T / D`` will do, which is why D vertices cost nothing.

    Parameters
    ----------
    n_points : int
        Number of points T.
    n_outputs : int
        Number of columns r.

    Notes
    -----
    ``scale / 2 (log |K| + tr(K^-1 Z Z^T))``, eq. (1) of [1]_; its slope in K is
    ``scale / 2 (K^-1 - K^-1 Z Z^T K^-1)``. All work goes on in the same four matrices, of which one triangle
    is used.

    References
    ----------
    .. [1] Lawrence, "Gaussian process latent variable models for visualisation of high dimensional data",
       NIPS 2003.
    """

    def __init__(self, n_points: int, n_outputs: int) -> None:
        self._radial: FloatArray = np.zeros((n_points, n_points))
        self._covariance: FloatArray = np.zeros((n_points, n_points))
        self._explained: FloatArray = np.zeros((n_points, n_points))
        self._solved: FloatArray = np.zeros((n_points, n_outputs), order="F")

    def __call__(self, X: FloatArray, Z: FloatArray, hyper: FloatArray, scale: float) -> Slopes:
        """Evaluate.

        Parameters
        ----------
        X : (T, q) float
            Latent points.
        Z : (T, r) float
            Outputs.
        hyper : (3,) or (4,) float
            Logarithms of a, g, s and, where there is a linear part, c.
        scale : float
            Weight; D for the likelihood itself.

        Returns
        -------
        Slopes
            Value and slopes.
        """
        linear = len(hyper) > 3
        a, g, s, c = *np.exp(hyper[:3]), float(np.exp(hyper[3])) if linear else 0.0
        inner = X @ X.T
        fill_covariance(inner, np.array([a, g, s, c]), self._radial, self._covariance)
        upper, fault = _FACTORISE(self._covariance.T, lower=0, overwrite_a=1, clean=0)
        if fault:
            return Slopes(np.inf, np.zeros_like(hyper), np.zeros_like(X), np.zeros_like(Z))
        log_det = 2 * float(np.log(np.diagonal(upper)).sum())
        inverse, _ = _INVERT(upper, lower=0, overwrite_c=1)
        solved = _MULTIPLY(1.0, inverse, Z, c=self._solved, lower=0, overwrite_c=1)
        explained = _SQUARE(1.0, solved, c=self._explained.T, lower=0, overwrite_c=1)
        value = 0.5 * scale * (log_det + float(np.vdot(Z, solved)))
        total, spread, trace = fill_slopes(inner, self._radial, inverse.T, explained.T, scale)
        slopes = [total, -0.5 * g * spread, s * trace]
        ends = np.asfortranarray(np.column_stack([X, np.ones(len(X))]))
        moved = _MULTIPLY(1.0, self._radial.T, ends, lower=0)
        points = -2 * g * (moved[:, -1:] * X - moved[:, :-1])
        if linear:
            pulled = _MULTIPLY(1.0, inverse, ends, lower=0)[:, :-1]
            slopes.append(c * float((pulled * X).sum()))
            points += 2 * c * pulled
        return Slopes(value, np.array(slopes), points, scale * solved)
