"""Gram matrices of centred data: their mean variance, their factors, their principal components."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_ROUNDING = 1e-13
"""Eigenvalues below this part of the largest are rounding."""


def centred_gram(Y: FloatArray) -> FloatArray:
    """Inner products of rows less their mean, over their number of columns.

    Parameters
    ----------
    Y : (T, D) float
        One row a frame.

    Returns
    -------
    (T, T) ndarray
        Gram matrix; its trace over T is the variance of one coordinate.
    """
    Y = Y - Y.mean(axis=0)
    return Y @ Y.T / max(Y.shape[1], 1)


def unit_gram(gram: FloatArray) -> tuple[FloatArray, float]:
    """Scale a Gram matrix to a mean variance of one.

    Parameters
    ----------
    gram : (T, T) float
        Gram matrix of centred rows.

    Returns
    -------
    gram : (T, T) ndarray
        The same over the mean variance; zeros where nothing varies.
    variance : float
        Mean variance of one row.
    """
    variance = float(np.trace(gram)) / len(gram)
    return (gram / variance if variance > 0 else np.zeros_like(gram)), variance


def gram_factor(gram: FloatArray) -> FloatArray:
    """Columns Z with ``Z Z^T = gram``: principal components, the widest first.

    Parameters
    ----------
    gram : (T, T) float
        Positive semidefinite.

    Returns
    -------
    (T, r) ndarray
        As many columns as the matrix has rank, one at least.
    """
    values, vectors = np.linalg.eigh(gram)
    rank = max(int((values > _ROUNDING * max(values[-1], 0.0)).sum()), 1)
    return vectors[:, ::-1][:, :rank] * np.sqrt(np.maximum(values[::-1][:rank], 0.0))
