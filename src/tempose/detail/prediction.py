"""What a fitted learner says of a motion: coefficients of the modes, variances, how far it has to guess."""

from __future__ import annotations

import numpy as np

from tempose.detail.basis import DetailBasis
from tempose.detail.learners.memory import frames_remembered
from tempose.detail.training import Inputs, Predictor
from tempose.typing import FloatArray

_FRAMES = 256
"""Frames asked for at a time: their weights of all training frames are held at once, for every region."""
_MEMORY = 64
"""Frames before them that any learner may look back to."""
_NEAR = 1 / 6
"""Seconds on either side that are no evidence of how far poses of a clip are from one another."""

_SPREAD = 0.3
"""Part of the distance from the mean pose that two poses may always be apart and still be alike."""


def coefficients(predictor: Predictor, detail: DetailBasis, inputs: Inputs, n_regions: int) -> FloatArray:
    """Predict the coefficients of the modes.

    Parameters
    ----------
    predictor : Predictor
        Fitted.
    detail : DetailBasis
        K modes.
    inputs : Inputs
        Q frames.
    n_regions : int
        Number of regions R.

    Returns
    -------
    (Q, R, 1 + K) float32 ndarray
        Metres; the mean first.
    """
    Q, K = len(inputs), detail.n_modes
    C = np.zeros((Q, n_regions, 1 + K), np.float32)
    C[..., 0] = detail.step
    for some, seen, skip in _blocks(predictor, inputs):
        weights = predictor.mix(seen).weights[:, skip:]
        C[some, :, 1:] = detail.step * (weights @ detail.coordinates).transpose(1, 0, 2)
    return C


def variances(predictor: Predictor, inputs: Inputs, n_regions: int) -> FloatArray:
    """Predict how wrong the residuals are.

    Parameters
    ----------
    predictor : Predictor
        Fitted.
    inputs : Inputs
        Q frames.
    n_regions : int
        Number of regions R.

    Returns
    -------
    (Q, R) ndarray
        Variance of one coordinate, metres squared.
    """
    V = np.zeros((len(inputs), n_regions))
    for some, seen, skip in _blocks(predictor, inputs):
        V[some] = predictor.mix(seen).variance[skip:]
    return V


def _blocks(predictor: Predictor, inputs: Inputs) -> list[tuple[slice, Inputs, int]]:
    memory = max(_MEMORY, frames_remembered(predictor))
    found: list[tuple[slice, Inputs, int]] = []
    for start in range(0, len(inputs), _FRAMES):
        stop, first = min(start + _FRAMES, len(inputs)), max(start - memory, 0)
        found.append((slice(start, stop), inputs.take(np.arange(first, stop)), start - first))
    return found


def nearest_distances(inputs: Inputs, others: Inputs, near: int = -1) -> FloatArray:
    """Angle from the pose of every frame to the most alike of others.

    Parameters
    ----------
    inputs : Inputs
        Q frames.
    others : Inputs
        T frames.
    near : int, default -1
        Where both are the same frames: those so near in time do not count.

    Returns
    -------
    (Q,) ndarray
        Root of the summed squares over the joints, radians; infinite where nothing is left to compare with.
    """
    A, B = (part.angles.reshape(len(part), -1) for part in (inputs, others))
    squares = np.square(A).sum(axis=1)[:, None] + np.square(B).sum(axis=1) - 2 * A @ B.T
    if near >= 0:
        apart = np.abs(np.arange(len(A))[:, None] - np.arange(len(B)))
        squares[(apart <= near) & (inputs.chains[:, None] == others.chains)] = np.inf
    return np.sqrt(np.maximum(squares.min(axis=1), 0.0))


def usual_distance(inputs: Inputs) -> float:
    """How far poses of the training are from the most alike one at another time.

    Parameters
    ----------
    inputs : Inputs
        T frames.

    Returns
    -------
    float
        95th percentile, radians; at least `_SPREAD` of their distance from the mean pose, since a cycle that
        repeats exactly does not make every other pose a stranger.
    """
    near = max(round(_NEAR * inputs.fps), 1)
    found = nearest_distances(inputs, inputs, min(near, (len(inputs) - 1) // 4))
    found = found[np.isfinite(found)]
    usual = float(np.percentile(found, 95)) if len(found) else 0.0
    spread = np.sqrt(inputs.angles.var(axis=0).sum())
    return max(usual, _SPREAD * float(spread))
