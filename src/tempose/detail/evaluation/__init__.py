"""Learners judged on frames that they have not seen."""

from tempose.detail.evaluation.choice import Choice, choose_learner
from tempose.detail.evaluation.errors import gram_errors, mixed_residuals
from tempose.detail.evaluation.evaluate import Evaluation, evaluate, rank_correlation
from tempose.detail.evaluation.folds import Score, cross_validate

__all__ = [
    "Choice",
    "Evaluation",
    "Score",
    "choose_learner",
    "cross_validate",
    "evaluate",
    "gram_errors",
    "mixed_residuals",
    "rank_correlation",
]
