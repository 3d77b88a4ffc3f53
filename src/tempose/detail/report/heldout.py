"""Learners compared on parts of the training that are left out, and the one to take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.detail.evaluation import Score, choose_learner, cross_validate
from tempose.detail.fitting import Gathered
from tempose.detail.learners import DEFAULT, LEARNERS
from tempose.detail.training import Learner
from tempose.typing import Progress

FEWEST = 12
"""Frames below which parts left out say nothing: the mean is then taken."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Which learner is taken, and what the others would do."""

    learner: Learner
    """The one to take."""
    why: str
    """A sentence for a person."""
    rows: dict[str, dict[str, Any]]
    """Name of a learner, or ``"skin"``, to ``rms``, ``rms_percent``, ``part`` of the skin's error,
    ``spearman``, ``calibration``, ``seconds`` and ``frames`` (rms of every frame)."""


def held_out(gathered: Gathered, learner: str | Learner, n_folds: int, progress: Progress) -> HeldOut:
    """Leave out parts of the training and predict them by every learner.

    Parameters
    ----------
    gathered : Gathered
        Training.
    learner : str or Learner
        ``"auto"``, a name, or a learner of one's own.
    n_folds : int
        Parts; 0 leaves the comparison out.
    progress : Progress
        Told about every training.

    Returns
    -------
    HeldOut
        Choice and table.
    """
    training = gathered.training
    named = {name: make() for name, make in LEARNERS.items()}
    own = None if isinstance(learner, str) else learner
    T = len(training.inputs)
    if T < FEWEST or n_folds == 0:
        name = DEFAULT if learner == "auto" and T >= FEWEST else "mean" if learner == "auto" else str(learner)
        why = "as asked for" if learner != "auto" else f"{T} frames, nothing left out"
        return HeldOut(own or named[name], why, {})
    if own is not None:
        named = {**named, own.name: own}
    if learner != "auto":
        named = {n: made for n, made in named.items() if n in _compared(own.name if own else str(learner))}
    scores = cross_validate(
        named,
        training,
        n_folds=n_folds,
        D=gathered.residuals,
        shares=gathered.learned_shares,
        progress=progress,
    )
    rows = _rows(gathered, scores)
    if learner != "auto":
        return HeldOut(own or named[str(learner)], "as asked for", rows)
    choice = choose_learner(scores, DEFAULT)
    return HeldOut(named[choice.name], choice.reason, rows)


def _compared(name: str) -> tuple[str, ...]:
    """Learners that a table shows where the choice is made already: the cheap ones and that one."""
    return ("mean", "nearest", "ridge", "gp", name)


def _rows(gathered: Gathered, scores: list[Score]) -> dict[str, dict[str, Any]]:
    D = gathered.rig.skin.mesh.diagonal
    squares = np.diagonal(gathered.training.gram) / (gathered.training.sizes.sum() / 3)
    alone = np.sqrt(np.maximum(squares, 0.0))
    skin = float(np.sqrt(np.mean(squares)))
    rows: dict[str, dict[str, Any]] = {
        "skin": {
            "rms": skin,
            "rms_percent": 100 * skin / D,
            "part": 1.0,
            "frames": [float(e) for e in alone],
        }
    }
    for score in scores:
        rows[score.name] = {
            "rms": score.rms,
            "rms_percent": 100 * score.rms / D,
            "part": score.rms / skin if skin > 0 else 1.0,
            "spearman": score.spearman,
            "calibration": score.calibration,
            "seconds": score.seconds,
            "frames": [float(e) for e in score.errors],
        }
    return rows
