"""Means of rotations."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray


def mean_rotation(q: FloatArray, weights: FloatArray | None = None) -> FloatArray:
    """Mean that treats q and -q alike: the top eigenvector of the summed outer products.

    Parameters
    ----------
    q : (k, ..., 4) float
        Unit quaternions, averaged over the first axis.
    weights : (k,) float, optional
        Weight of each.

    Returns
    -------
    (..., 4) ndarray
        Unit quaternions with ``w >= 0``.

    References
    ----------
    .. [1] Markley et al., "Averaging Quaternions", Journal of Guidance, Control and Dynamics 30, 2007.
    """
    q = np.asarray(q, dtype=np.float64)
    w = np.ones(len(q)) if weights is None else np.asarray(weights, dtype=np.float64)
    moment = np.einsum("k,k...i,k...j->...ij", w, q, q)
    mean = np.linalg.eigh(moment)[1][..., -1]
    return np.where(mean[..., :1] < 0, -mean, mean)
