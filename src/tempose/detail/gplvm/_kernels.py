"""Elementwise loops of the likelihoods, over one triangle of every matrix."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray

_NOTHING = 40.0
"""exp of minus this is lost beside the diagonal; kept, its products are subnormal numbers, which cost ten
times as much."""


@njit(cache=True)
def rbf_matrix(inner: FloatArray, variance: float, rate: float) -> FloatArray:  # pragma: no cover
    """Lower triangle of ``variance exp(-rate |x_i - x_j|^2 / 2)``, the rest zero.

    Parameters
    ----------
    inner : (T, T) float
        Inner products of the points.
    variance, rate : float
        Of the kernel.

    Returns
    -------
    (T, T) ndarray
        Lower triangle and diagonal.
    """
    T = len(inner)
    P = np.zeros((T, T))
    for i in range(T):
        for j in range(i):
            exponent = 0.5 * rate * max(inner[i, i] + inner[j, j] - 2.0 * inner[i, j], 0.0)
            if exponent < _NOTHING:
                P[i, j] = variance * np.exp(-exponent)
        P[i, i] = variance
    return P


@njit(cache=True)
def rbf_slopes(
    inner: FloatArray, P: FloatArray, inverse: FloatArray, explained: FloatArray, scale: float
) -> tuple[FloatArray, FloatArray, float, float]:  # pragma: no cover
    """Find what every gradient of one likelihood needs, from lower triangles.

    Parameters
    ----------
    inner : (T, T) float
        Inner products of the points.
    P : (T, T) float
        Lower triangle of the radial part of the kernel.
    inverse : (T, T) float
        Lower triangle of the inverse of the whole kernel.
    explained : (T, T) float
        Lower triangle of ``inverse Y Y^T inverse / D``.
    scale : float
        Weight of the likelihood.

    Returns
    -------
    E : (T, T) ndarray
        Slope of the negative log likelihood in the kernel, symmetric.
    W : (T, T) ndarray
        ``E`` times the radial part, elementwise.
    total : float
        Sum of `W`.
    spread : float
        Sum of `W` times the squared distances.
    """
    T = len(inner)
    E, W = np.zeros((T, T)), np.zeros((T, T))
    total, spread = 0.0, 0.0
    for i in range(T):
        for j in range(i + 1):
            e = 0.5 * scale * (inverse[i, j] - explained[i, j])
            w = e * P[i, j]
            E[i, j] = e
            E[j, i] = e
            W[i, j] = w
            W[j, i] = w
            if i == j:
                total += w
            else:
                total += 2.0 * w
                spread += 2.0 * w * (inner[i, i] + inner[j, j] - 2.0 * inner[i, j])
    return E, W, total, spread


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
