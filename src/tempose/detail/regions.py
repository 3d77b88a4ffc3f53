"""Soft regions of a skin, and the Gram matrices of the residuals in each."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray


def region_grams(D: FloatArray, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Inner products of residuals, shared out over regions.

    Parameters
    ----------
    D : (T, n, 3) float
        Residuals, metres.
    shares : (n, R) float
        Share of every vertex in every region; rows sum to 1. By default the skin weights.

    Returns
    -------
    grams : (R, T, T) ndarray
        Metres squared.
    sizes : (R,) ndarray
        Coordinates that each region holds.
    """
    T, R = len(D), shares.shape[1]
    grams = np.zeros((R, T, T))
    for r in range(R):
        inside = np.flatnonzero(shares[:, r] > 0)
        part = D[:, inside] * np.sqrt(shares[inside, r])[:, None]
        flat = part.reshape(T, -1)
        grams[r] = flat @ flat.T
    return grams, 3 * shares.sum(axis=0)
