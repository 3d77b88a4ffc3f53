"""How far predicted residuals are from true ones."""

from __future__ import annotations

import numpy as np

from tempose.detail.training import Mixture
from tempose.typing import FloatArray, IntArray


def gram_errors(grams: FloatArray, weights: FloatArray, train: IntArray, test: IntArray) -> FloatArray:
    """Squared errors of predictions in each region, from inner products alone.

    Parameters
    ----------
    grams : (R, T, T) float
        Inner products of the raw residuals of all frames, metres squared.
    weights : (R or 1, Q, k) float
        Of the k training frames for each of Q predicted ones, see `Mixture`.
    train : (k,) int
        Frames of the training.
    test : (Q,) int
        Frames predicted.

    Returns
    -------
    (Q, R) ndarray
        Squared distance of prediction and truth, shared out over regions, metres squared.

    Notes
    -----
    Where regions have weights of their own, a vertex in several of them takes the mean of their predictions
    by its shares; its squared error is at most the mean of theirs, which is what the sum over regions is.
    """
    R, T = grams.shape[:2]
    errors = np.zeros((len(test), R))
    for r in range(R):
        W = weights[r if len(weights) == R else 0]
        lines = np.zeros((len(test), T))
        lines[:, train] = -W + (W.sum(axis=1, keepdims=True) - 1) / len(train)
        lines[np.arange(len(test)), test] += 1
        errors[:, r] = np.einsum("qt,qt->q", lines @ grams[r], lines)
    return np.maximum(errors, 0.0)


def mixed_residuals(D: FloatArray, shares: FloatArray, mixture: Mixture) -> FloatArray:
    """Carry out a mixture, vertex by vertex.

    Parameters
    ----------
    D : (T, n, 3) float
        Residuals of the training, metres.
    shares : (n, R) float
        Share of every vertex in every region.
    mixture : Mixture
        For Q frames.

    Returns
    -------
    (Q, n, 3) ndarray
        Predicted residuals, metres.
    """
    T, n = D.shape[:2]
    mean = D.mean(axis=0)
    centred = np.asarray(D - mean, dtype=np.float64)
    weights = mixture.weights
    if len(weights) == 1:
        return mean + (weights[0] @ centred.reshape(T, -1)).reshape(-1, n, 3)
    out = np.repeat(mean[None].astype(np.float64), weights.shape[1], axis=0)
    for r, W in enumerate(weights):
        inside = np.flatnonzero(shares[:, r])
        part = (W @ centred[:, inside].reshape(T, -1)).reshape(len(W), -1, 3)
        out[:, inside] += shares[inside, r, None] * part
    return out
