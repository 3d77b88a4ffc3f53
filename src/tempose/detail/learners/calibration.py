"""How wrong predicted variances are, by blocks of the training left out."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from tempose.regression import Kernel, blocked_folds
from tempose.typing import FloatArray, IntArray

_LIMITS = (0.3, 10.0)
"""Of the factor: beyond them the folds say more about the clip than about the kernel."""


def variance_factor(
    kernel: Kernel, X: FloatArray, S: FloatArray, chains: IntArray, n_folds: int = 5
) -> float:
    """Measure true against predicted squared errors of frames left out in blocks.

    Parameters
    ----------
    kernel : Kernel
        For outputs of variance 1.
    X : (T, P) float
        Inputs.
    S : (T, T) float
        Inner products of the centred outputs, trace T.
    chains : (T,) int
        Which clip every frame is from.
    n_folds : int, default 5
        Number of blocks.

    Returns
    -------
    float
        What predicted variances have to be multiplied by.

    Notes
    -----
    The kernel stays as it is, so that one inverse serves all blocks: without the frames B a Gaussian process
    predicts them with error ``(K^-1_BB)^-1 (K^-1 Y)_B`` and covariance ``(K^-1_BB)^-1``, section
    5.4.2 of [1]_.

    References
    ----------
    .. [1] Rasmussen and Williams, "Gaussian processes for machine learning", MIT Press 2006.
    """
    K = kernel(X, X)
    K.flat[:: len(K) + 1] += kernel.noise
    inverse = cho_solve(cho_factor(K, lower=True), np.eye(len(K)))
    wrong = predicted = 0.0
    for train, test in blocked_folds(chains, n_folds):
        out = np.setdiff1d(np.arange(len(X)), train)
        inside = np.isin(out, test)
        covariance = np.linalg.inv(inverse[np.ix_(out, out)])[inside]
        lines = covariance @ inverse[out]
        wrong += float(np.einsum("qt,qt->", lines @ S, lines))
        predicted += float(np.diagonal(covariance[:, inside]).sum())
    return float(np.clip(wrong / predicted, *_LIMITS)) if predicted > 0 else 1.0
