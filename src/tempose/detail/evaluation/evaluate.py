"""One learner on frames that it has not seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import rankdata

from tempose.detail.evaluation.errors import gram_errors, mixed_residuals
from tempose.detail.learners.memory import frame_ages, frames_remembered
from tempose.detail.training import Inputs, Learner, Mixture, Predictor, Training
from tempose.typing import FloatArray, IntArray

_PAST = 32
"""Frames before those predicted that any learner may look back to."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Errors of a learner on frames held out, and what it said about them."""

    errors: FloatArray
    """(Q,) rms of the difference of predicted and true residuals over the vertices, metres."""
    predicted: FloatArray
    """(Q,) the same as the predicted variance has it, metres."""
    by_region: FloatArray
    """(Q, R) rms of every region, metres."""
    predicted_by_region: FloatArray
    """(Q, R) as the predicted variance has it, metres."""

    @property
    def rms(self) -> float:
        """Over all frames, metres."""
        return float(np.sqrt(np.mean(np.square(self.errors))))

    @property
    def spearman(self) -> float:
        """Rank correlation of predicted and true errors over the frames; 0 where one of them is constant."""
        return rank_correlation(self.predicted, self.errors)

    @property
    def regional_spearman(self) -> float:
        """The same over all frames and regions."""
        return rank_correlation(self.predicted_by_region.ravel(), self.by_region.ravel())

    @property
    def calibration(self) -> float:
        """Predicted over true rms; 1 is right, less is too sure."""
        true = self.rms
        return float(np.sqrt(np.mean(np.square(self.predicted))) / true) if true > 0 else 1.0


def evaluate(
    learner: Learner,
    training: Training,
    train: IntArray,
    test: IntArray,
    *,
    D: FloatArray | None = None,
    shares: FloatArray | None = None,
) -> Evaluation:
    """Train on some frames and predict others.

    Parameters
    ----------
    learner : Learner
        Way to learn.
    training : Training
        All frames.
    train : (k,) int
        Frames of the training, sorted.
    test : (Q,) int
        Frames predicted, sorted.
    D : (T, n, 3) float, optional
        Residuals of all frames, metres; without them errors of learners with a mixture for each region are
        upper bounds, see `gram_errors`.
    shares : (n, R) float, optional
        Share of every vertex in every region; goes with `D`.

    Returns
    -------
    Evaluation
        Errors, true and predicted.

    Raises
    ------
    ValueError
        If a frame is trained on and tested, or `D` comes without `shares`.
    """
    train, test = np.asarray(train), np.asarray(test)
    both = np.intersect1d(train, test)
    if len(both):
        raise ValueError(f"train and test must not share frames, got {both[0]} in both")
    if (D is None) != (shares is None):
        raise ValueError("D and shares must be given together, got one of them")
    mixture = _with_past(learner.fit(training.take(train)), training.inputs, test)
    squares = gram_errors(training.grams, mixture.weights, train, test)
    total = squares.sum(axis=1)
    if D is not None and shares is not None and len(mixture.weights) > 1:
        wrong = mixed_residuals(D[train], shares, mixture) - D[test]
        total = np.square(wrong).sum(axis=(1, 2))
    return _evaluation(mixture, squares, total, training.sizes)


def _with_past(predictor: Predictor, inputs: Inputs, test: IntArray) -> Mixture:
    """Predict frames; what came before them is known, as it is when a motion is posed."""
    ages = frame_ages(inputs.chains)[test]
    memory = max(_PAST, frames_remembered(predictor))
    past = test[:, None] - np.minimum(ages[:, None], np.arange(memory + 1))
    frames = np.unique(past)
    mixture = predictor.mix(inputs.take(frames))
    rows = np.searchsorted(frames, test)
    return Mixture(mixture.weights[:, rows], mixture.variance[rows])


def _evaluation(mixture: Mixture, squares: FloatArray, total: FloatArray, sizes: FloatArray) -> Evaluation:
    n = sizes.sum() / 3
    variance = np.broadcast_to(mixture.variance, squares.shape)
    by_region = np.sqrt(squares / np.maximum(sizes / 3, 1e-12))
    return Evaluation(
        errors=np.sqrt(total / n),
        predicted=np.sqrt(variance @ sizes / n),
        by_region=by_region,
        predicted_by_region=np.sqrt(3 * variance),
    )


def rank_correlation(a: FloatArray, b: FloatArray) -> float:
    """Spearman's rank correlation.

    Parameters
    ----------
    a, b : (k,) float
        Pairs of values; equal ones share their mean rank.

    Returns
    -------
    float
        From -1 to 1; 0 where one of them is constant.

    Examples
    --------
    >>> rank_correlation([1.0, 2.0, 3.0], [1.0, 10.0, 20.0])
    1.0
    """
    x, y = rankdata(a) - (len(a) + 1) / 2, rankdata(b) - (len(b) + 1) / 2
    size = float(np.sqrt((x @ x) * (y @ y)))
    return float(x @ y) / size if size > 0 else 0.0
