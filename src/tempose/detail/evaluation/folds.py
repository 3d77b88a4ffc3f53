"""Learners against each other on blocks left out, and which of them to take."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tempose.detail.evaluation.evaluate import Evaluation, evaluate, rank_correlation
from tempose.detail.training import Learner, Training
from tempose.regression import blocked_folds
from tempose.typing import FloatArray, Progress, silent

BASELINE = "mean"
"""Name of the learner that every other has to beat."""


@dataclass(frozen=True, eq=False)
class Score:
    """What blocks left out say of one learner."""

    name: str
    """Of the learner."""
    rms: float
    """Over all frames, each predicted without its block, metres."""
    errors: FloatArray
    """(T,) rms of every frame, metres."""
    fold_rms: FloatArray
    """(folds,) rms of each block, metres."""
    spearman: float
    """Rank correlation of predicted and true errors over all frames."""
    calibration: float
    """Predicted over true rms."""
    seconds: float
    """Of all trainings and predictions together."""


def cross_validate(
    learners: Mapping[str, Learner],
    training: Training,
    *,
    n_folds: int = 5,
    gap: int = 1,
    D: FloatArray | None = None,
    shares: FloatArray | None = None,
    progress: Progress = silent,
) -> list[Score]:
    """Predict every block of frames from the rest, by each learner.

    Parameters
    ----------
    learners : mapping of str to Learner
        By name.
    training : Training
        T frames.
    n_folds : int, default 5
        Number of contiguous blocks.
    gap : int, default 1
        Frames left out on either side of a block.
    D : (T, n, 3) float, optional
        Residuals, metres; see `evaluate`.
    shares : (n, R) float, optional
        Share of every vertex in every region; goes with `D`.
    progress : Progress
        Told about every training.

    Returns
    -------
    list of Score
        In the order given.

    Raises
    ------
    ValueError
        If there are too few frames to leave any out.
    """
    folds = blocked_folds(training.inputs.chains, n_folds, gap)
    if any(len(train) < 2 for train, _ in folds):
        raise ValueError(
            f"training must hold enough frames to leave out {n_folds} blocks, got {len(training.inputs)}"
        )
    scores: list[Score] = []
    for i, (name, learner) in enumerate(learners.items()):
        start, parts = time.perf_counter(), list[Evaluation]()
        for f, (train, test) in enumerate(folds):
            parts.append(evaluate(learner, training, train, test, D=D, shares=shares))
            progress(i * len(folds) + f + 1, len(learners) * len(folds), "held-out blocks")
        scores.append(_score(name, parts, time.perf_counter() - start))
    return scores


def _score(name: str, parts: list[Evaluation], seconds: float) -> Score:
    errors = np.concatenate([part.errors for part in parts])
    predicted = np.concatenate([part.predicted for part in parts])
    rms = float(np.sqrt(np.mean(errors**2)))
    said = float(np.sqrt(np.mean(predicted**2)))
    return Score(
        name=name,
        rms=rms,
        errors=errors,
        fold_rms=np.array([part.rms for part in parts]),
        spearman=rank_correlation(predicted, errors),
        calibration=said / rms if rms > 0 else 1.0,
        seconds=seconds,
    )
