"""Ways to learn residuals, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from tempose.detail.learners.constant import MeanLearner
from tempose.detail.learners.gp import PlainGaussianProcess
from tempose.detail.learners.latent import LatentLearner
from tempose.detail.learners.nearest import NearestLearner
from tempose.detail.learners.regional import RegionalGaussianProcess
from tempose.detail.learners.ridge import RidgeLearner
from tempose.detail.training import Learner

__all__ = [
    "DEFAULT",
    "LEARNERS",
    "LatentLearner",
    "MeanLearner",
    "NearestLearner",
    "PlainGaussianProcess",
    "RegionalGaussianProcess",
    "RidgeLearner",
]

DEFAULT = "regional-gp"
"""Name of the learner that is taken unless another predicts held-out frames better."""

LEARNERS: Mapping[str, Callable[[], Learner]] = MappingProxyType(
    {
        "mean": MeanLearner,
        "nearest": NearestLearner,
        "ridge": RidgeLearner,
        "gp": PlainGaussianProcess,
        "regional-gp": RegionalGaussianProcess,
        "gplvm": LatentLearner,
        "gplvm-paper": LatentLearner.paper,
    }
)
"""Makers of the learners with their default settings."""
