"""Elementwise loops of the likelihoods, over one triangle of every matrix."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray

_NOTHING = 40.0
"""exp of minus this is lost beside the diagonal; kept, its products are subnormal numbers, which cost ten
times as much."""


@njit(cache=True)
def fill_covariance(
    inner: FloatArray, hyper: FloatArray, P: FloatArray, K: FloatArray
) -> None:  # pragma: no cover
    """Write the lower triangle of ``a exp(-g |x_i - x_j|^2 / 2) + c x_i . x_j + s [i = j]``.

    Parameters
    ----------
    inner : (T, T) float
        Inner products of the points.
    hyper : (4,) float
        a, g, s and c.
    P : (T, T) float
        Receives the radial part.
    K : (T, T) float
        Receives all of it.
    """
    a, g, s, c = hyper
    for i in range(len(inner)):
        for j in range(i):
            exponent = 0.5 * g * max(inner[i, i] + inner[j, j] - 2.0 * inner[i, j], 0.0)
            P[i, j] = a * np.exp(-exponent) if exponent < _NOTHING else 0.0
            K[i, j] = P[i, j] + c * inner[i, j]
        P[i, i] = a
        K[i, i] = a + c * inner[i, i] + s


@njit(cache=True)
def fill_slopes(
    inner: FloatArray, P: FloatArray, inverse: FloatArray, explained: FloatArray, scale: float
) -> tuple[float, float, float]:  # pragma: no cover
    """Turn lower triangles into what every gradient of one likelihood needs.

    Parameters
    ----------
    inner : (T, T) float
        Inner products of the points.
    P : (T, T) float
        Radial part of the covariance K; becomes itself times the slope of the likelihood in K, elementwise.
    inverse : (T, T) float
        Inverse of K; becomes the slope of the negative log likelihood in K.
    explained : (T, T) float
        ``inverse Y Y^T inverse``, over the number of outputs.
    scale : float
        Weight of the likelihood.

    Returns
    -------
    total : float
        Sum over the whole of what `P` becomes.
    spread : float
        The same times the squared distances of the points.
    trace : float
        Of the slope in K.
    """
    total, spread, trace = 0.0, 0.0, 0.0
    for i in range(len(inner)):
        for j in range(i):
            e = 0.5 * scale * (inverse[i, j] - explained[i, j])
            w = e * P[i, j]
            inverse[i, j] = e
            P[i, j] = w
            total += 2.0 * w
            spread += 2.0 * w * (inner[i, i] + inner[j, j] - 2.0 * inner[i, j])
        e = 0.5 * scale * (inverse[i, i] - explained[i, i])
        inverse[i, i] = e
        P[i, i] *= e
        total += P[i, i]
        trace += e
    return total, spread, trace


@njit(cache=True)
def expected_squares(
    H: FloatArray,
    apart: FloatArray,
    squares: FloatArray,
    unsure: FloatArray,
    variance: float,
    rate: float,
    dim: int,
) -> FloatArray:  # pragma: no cover
    """Sum `H` times the expected products of kernels at uncertain points.

    Parameters
    ----------
    H : (T, T) float
        Symmetric.
    apart : (T, T) float
        Squared distances of the points of the training.
    squares : (Q, T) float
        Squared distances of the means of the queries to them.
    unsure : (Q,) float
        Variance v of each coordinate of a query.
    variance, rate : float
        a and g of the kernel.
    dim : int
        Latent dimensions q.

    Returns
    -------
    (Q,) ndarray
        ``sum_ij H_ij E[k_i k_j]``.

    Notes
    -----
    ``E[k_i k_j] = a^2 (1 + 2 g v)^(-q/2) exp(-g |x_i - x_j|^2 / 4 - g |m - (x_i + x_j)/2|^2 / (1 + 2 g v))``,
    and the distance to the middle follows from those to its ends.
    """
    Q, T = squares.shape
    sums = np.zeros(Q)
    for k in range(Q):
        c = rate / (1.0 + 2.0 * rate * unsure[k])
        near = np.exp(-0.5 * c * squares[k])
        total = 0.0
        for i in range(T):
            row = 0.0
            if near[i] > 1e-15:
                for j in range(i):
                    if near[j] > 1e-15:
                        row += H[i, j] * near[j] * np.exp(-0.25 * (rate - c) * apart[i, j])
                total += near[i] * (2.0 * row + H[i, i] * near[i])
        sums[k] = variance**2 * (c / rate) ** (0.5 * dim) * total
    return sums
