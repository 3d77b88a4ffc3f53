"""Soft regions of a skin, and the Gram matrices of the residuals in each."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_VERTICES = 1024
"""Vertices that are multiplied at a time: few enough for the sums of float32 to keep their digits."""


def region_shares(weights: FloatArray, least: float = 0.05) -> FloatArray:
    """Share of every vertex in every region: its skin weights, without the long tails that heat has.

    Parameters
    ----------
    weights : (n, J) float
        Skin weights.
    least : float, default 0.05
        Taken off every weight, so that small ones fade to nothing without a seam.

    Returns
    -------
    (n, J) ndarray
        Rows that sum to 1; of zeros for vertices that are bound to nothing.
    """
    shares = np.maximum(weights - least, 0.0)
    # weights spread over so many joints that all are small stay as they are
    thin = shares.max(axis=1, initial=0.0) < 2 * least
    shares[thin] = weights[thin]
    total = shares.sum(axis=1, keepdims=True)
    return np.divide(shares, total, out=np.zeros_like(shares), where=total > 0)


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
    T, n, R = len(D), len(shares), shares.shape[1]
    grams = np.zeros((R, T, T))
    # a vertex after another, so that those of a region are copied in long runs
    columns = np.ascontiguousarray(D.reshape(T, 3 * n).T).reshape(n, 3, T)
    for r in range(R):
        inside = np.flatnonzero(shares[:, r] > 0)
        roots = np.sqrt(shares[inside, r]).astype(D.dtype)
        for start in range(0, len(inside), _VERTICES):
            some = slice(start, start + _VERTICES)
            flat = (columns[inside[some]] * roots[some, None, None]).reshape(-1, T)
            grams[r] += flat.T @ flat
    return grams, 3 * shares.sum(axis=0)
