"""One Gaussian process for the whole body, one length scale: the baseline of every better learner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.calibration import variance_factor
from tempose.detail.learners.features import TwoFrames
from tempose.detail.learners.kernel_predictor import KernelPredictor, spread_frames, unit_grams
from tempose.detail.training import Training
from tempose.regression import fit_kernel, one_blas_thread


@dataclass(frozen=True)
class PlainGaussianProcess:
    """Gaussian process on the angles of two frames: smooth + linear + noise, by maximum likelihood."""

    iterations: int = 60
    """Largest number of steps from each start."""
    judged: int = 400
    """At most so many frames judge kernels."""
    inducing: int = 400
    """At most so many frames are compared with at a query; 0 for all."""
    name: str = "gp"
    """Name in tables and options."""

    def fit(self, training: Training) -> KernelPredictor:
        """Learn from T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        KernelPredictor
            One mixture for all regions.
        """
        features = TwoFrames()
        X = features(training.inputs)
        some = spread_frames(len(X), self.judged)
        grams, spreads = unit_grams(training.gram[None], training.sizes.sum(keepdims=True), some)
        if len(X) < 3 or not spreads[0]:
            return KernelPredictor(features, [None], X, spreads)
        with one_blas_thread():
            groups = np.zeros(X.shape[1], dtype=np.int64)
            kernel = fit_kernel(X[some], groups, grams[0], iterations=self.iterations).kernel
            factor = variance_factor(kernel, X[some], grams[0], training.inputs.chains[some])
        return KernelPredictor(features, [kernel], X, factor * spreads, self.inducing)
