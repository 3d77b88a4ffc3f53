"""Learning from few frames: folds of a clip, ridge regression, Gaussian processes."""

from tempose.regression.folds import blocked_folds

__all__ = ["blocked_folds"]
