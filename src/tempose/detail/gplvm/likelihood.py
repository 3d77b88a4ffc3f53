"""The negative log likelihood of one Gaussian process over latent points, with its slopes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import get_blas_funcs, get_lapack_funcs

from tempose.detail.gplvm._kernels import rbf_matrix, rbf_slopes
from tempose.typing import FloatArray

_MULTIPLY, _SQUARE = get_blas_funcs(("symm", "syrk"), dtype=np.float64)
_FACTORISE, _INVERT = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)


class Slopes(NamedTuple):
    """Value of a likelihood and its slopes."""

    value: float
    """Negative log likelihood, without the constant."""
    hyper: FloatArray
    """(3,) or (4,) slopes in the logarithms of variance, rate, noise and linear variance."""
    points: FloatArray
    """(T, q) slope in the points of the kernel."""
    outputs: FloatArray
    """(T, r) slope in the outputs."""


def negative_log_likelihood(X: FloatArray, Z: FloatArray, hyper: FloatArray, scale: float) -> Slopes:
    """Minus log of ``N(Z; 0, K(X))`` a column of outputs, with every slope.

    Parameters
    ----------
    X : (T, q) float
        Latent points.
    Z : (T, r) float
        Outputs up to a rotation of their columns: any factor of ``Y Y^T / D`` will do, which is why D
        vertices cost nothing.
    hyper : (3,) or (4,) float
        Logarithms of the variance a, the rate g and the noise s of ``a exp(-g |x - x'|^2 / 2) + s [x = x']``,
        and of c of a linear part ``c x . x'``.
    scale : float
        Weight; D for the likelihood itself.

    Returns
    -------
    Slopes
        ``scale / 2 (log |K| + tr(K^-1 Z Z^T))`` and its slopes; the value is infinite where K is singular.
    """
    a, g, s = np.exp(hyper[:3])
    inner = X @ X.T
    P = rbf_matrix(inner, a, g)
    c = float(np.exp(hyper[3])) if len(hyper) > 3 else 0.0
    K = P + c * inner
    K.flat[:: len(K) + 1] += s
    L, fault = _FACTORISE(K.T, lower=0, overwrite_a=1)
    if fault:
        return Slopes(np.inf, np.zeros_like(hyper), np.zeros_like(X), np.zeros_like(Z))
    log_det = 2 * np.log(np.diagonal(L)).sum()
    inverse, _ = _INVERT(L, lower=0, overwrite_c=1)
    A = _MULTIPLY(1.0, inverse, np.asfortranarray(Z), lower=0)
    explained = _SQUARE(1.0, A, lower=0)
    E, W, total, spread = rbf_slopes(inner, P, inverse.T, explained.T, scale)
    slopes = [total, -0.5 * g * spread, s * np.trace(E)]
    points = -2 * g * (W.sum(axis=1)[:, None] * X - W @ X)
    if c:
        EX = E @ X
        slopes.append(c * float((EX * X).sum()))
        points += 2 * c * EX
    value = 0.5 * scale * (log_det + float((Z * A).sum()))
    return Slopes(value, np.array(slopes), points, scale * A)
