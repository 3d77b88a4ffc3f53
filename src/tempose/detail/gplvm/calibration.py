"""How unsure latent points really are, and how wrong residuals: by blocks of the training left out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tempose.detail.gplvm.back_map import BackMap
from tempose.detail.gplvm.prediction import LatentProcess
from tempose.regression import blocked_folds
from tempose.typing import FloatArray, IntArray

_WIDER = (1.0, 1.5, 2.0, 3.0)
"""Factors tried. The back-map knows latent points that were made to fit it and thinks itself surer than it
is."""
_ASKED = 20
"""At most so many frames of a block are asked for."""
_LIMITS = (0.3, 10.0)
"""Of the factor on the variance: beyond them the blocks say more about the clip than about the model."""


class Widening(NamedTuple):
    """Corrections of predicted variances."""

    points: float
    """Factor on the variance of latent points."""
    residuals: float
    """Factor on the variance of residuals, given that."""


def widen_variances(back: BackMap, process: LatentProcess, chains: IntArray) -> Widening:
    """Compare predicted with true errors of blocks left out; the hyperparameters and points stay.

    Parameters
    ----------
    back : BackMap
        From T poses to latent points.
    process : LatentProcess
        From latent points to residuals.
    chains : (T,) int
        Which clip every frame is from.

    Returns
    -------
    Widening
        Of the factors on the variance of latent points the one that explains the errors best, and what the
        variance of residuals then still lacks.
    """
    found = [
        _left_out(back, process, train, test[:: max(-(-len(test) // _ASKED), 1)])
        for train, test in blocked_folds(chains)
        if len(train) > 1
    ]
    if not found:
        return Widening(1.0, 1.0)
    squares, variances = np.concatenate(found, axis=1)
    lacking = squares.mean(axis=0) / variances.mean(axis=0)
    best = int(np.abs(np.log(np.maximum(lacking, 1e-300))).argmin())
    return Widening(_WIDER[best], float(np.clip(lacking[best], *_LIMITS)))


def _left_out(back: BackMap, process: LatentProcess, train: IntArray, test: IntArray) -> FloatArray:
    """Return squared errors and variances (2, frames, factors) of residuals of variance 1."""
    nearer = BackMap(back.kernel, back.Y[train], back.X[train], np.zeros(back.Y.shape[1]))
    points, unsure = nearer(back.Y[test])
    known = LatentProcess(process.X[train], process.hyper, process.gram[np.ix_(train, train)])
    found = np.zeros((2, len(test), len(_WIDER)))
    for i, factor in enumerate(_WIDER):
        lines = np.zeros((len(test), len(process.X)))
        lines[:, train] = -known.weights(points, factor * unsure)
        lines[np.arange(len(test)), test] += 1.0
        found[0, :, i] = np.einsum("qt,qt->q", lines @ process.gram, lines)
        found[1, :, i] = known.variance(points, factor * unsure)
    return found
