"""Means of rotations."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray


def mean_rotation(q: FloatArray, weights: FloatArray | None = None) -> FloatArray:
    """Mean that treats q and -q alike: the top eigenvector of the summed outer products.

    Parameters
    ----------
    q : (k, ..., 4) float
        Unit quaternions, averaged over the first axis.
    weights : (k,) float, optional
        Weight of each, not negative, not all zero.

    Returns
    -------
    (..., 4) ndarray
        Unit quaternions with ``w >= 0``.

    Raises
    ------
    ValueError
        If there is no rotation, or the weights cannot be weights.

    References
    ----------
    .. [1] Markley et al., "Averaging Quaternions", Journal of Guidance, Control and Dynamics 30, 2007.
    """
    q = np.asarray(q, dtype=np.float64)
    w = mean_weights(weights, len(q))
    moment = np.einsum("k,k...i,k...j->...ij", w, q, q)
    mean = np.linalg.eigh(moment)[1][..., -1]
    return np.where(mean[..., :1] < 0, -mean, mean)


def mean_weights(weights: FloatArray | None, count: int) -> FloatArray:
    """Check the weights of a mean and scale them to sum 1.

    Parameters
    ----------
    weights : (count,) float, optional
        None weighs all alike.
    count : int
        Number of things to average.

    Returns
    -------
    (count,) ndarray
        Weights that sum to 1.

    Raises
    ------
    ValueError
        If there is nothing to average, or a weight is negative or not finite, or all are zero.
    """
    if count == 0:
        raise ValueError("a mean needs at least one rotation or point, got none")
    w = np.ones(count) if weights is None else as_floats(weights, "weights", (count,))
    if (w < 0).any() or w.sum() <= 0:
        raise ValueError(f"weights must be >= 0 and not all zero, got a sum of {w.sum():.4g}")
    return w / w.sum()
