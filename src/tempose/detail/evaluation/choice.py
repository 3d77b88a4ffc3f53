"""Which learner to take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tempose.detail.evaluation.folds import BASELINE, Score

MARGIN = 0.03
"""Differences of held-out errors below this part say nothing; the preferred learner then stays."""


@dataclass(frozen=True)
class Choice:
    """A learner and why it was taken."""

    name: str
    """Of the learner."""
    reason: str
    """A sentence for the report."""


def choose_learner(scores: Sequence[Score], preferred: str = "regional-gp", margin: float = MARGIN) -> Choice:
    """Choose by blocks left out: the preferred learner unless another is clearly better or none is any good.

    Parameters
    ----------
    scores : sequence of Score
        Of all learners tried; the one called ``"mean"`` should be among them.
    preferred : str, default "regional-gp"
        Taken as long as no other is better by more than `margin`.
    margin : float, default 0.03
        Part of the error.

    Returns
    -------
    Choice
        The learner and the reason. The mean is taken where the best does not beat it by more than `margin`
        over all frames and in most of the blocks: motion then says nothing about residuals that lasts.

    Raises
    ------
    ValueError
        If there are no scores.
    """
    if not scores:
        raise ValueError("scores must hold one learner or more, got none")
    by_name = {score.name: score for score in scores}
    best = min(scores, key=lambda score: score.rms)
    if preferred in by_name and by_name[preferred].rms <= (1 + margin) * best.rms:
        best = by_name[preferred]
    base = by_name.get(BASELINE)
    if base is not None and best is not base and not _beats(best, base, margin):
        why = f"{best.name} has {_part(best, base)} of the mean's error, not clearly less"
        return Choice(BASELINE, f"blocks left out: {why}")
    if base is None or best is base:
        return Choice(best.name, f"blocks left out: {best.name} has the least error")
    return Choice(best.name, f"blocks left out: {best.name} has {_part(best, base)} of the mean's error")


def _beats(score: Score, base: Score, margin: float) -> bool:
    better = score.fold_rms < base.fold_rms
    return score.rms < (1 - margin) * base.rms and bool(np.mean(better) > 0.5)


def _part(score: Score, base: Score) -> str:
    return f"{score.rms / base.rms:.0%}" if base.rms > 0 else "all"
