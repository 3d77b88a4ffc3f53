"""Ways to learn residuals, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from tempose.detail.learners.constant import MeanLearner
from tempose.detail.training import Learner

__all__ = ["LEARNERS", "MeanLearner"]

LEARNERS: Mapping[str, Callable[[], Learner]] = MappingProxyType({"mean": MeanLearner})
"""Makers of the learners with their default settings."""
