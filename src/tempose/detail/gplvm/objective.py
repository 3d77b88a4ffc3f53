"""The product of three likelihoods of the shared latent model: skeleton, detail and dynamics."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose.detail.gplvm.likelihood import LatentLikelihood
from tempose.typing import FloatArray, IntArray

HYPER = (3, 3, 4)
"""Number of hyperparameters of skeleton, detail and dynamics."""


@dataclass(frozen=True, eq=False)
class SharedObjective:
    """Minus the logarithm of the joint likelihood of pose, detail and the latent path.

    Poses and details are given by factors of their T x T Gram matrices, so that an evaluation costs the same
    for 500 vertices and for 100 000.
    """

    skeleton: FloatArray
    """(T, r) factor of the Gram matrix of the poses, mean variance 1."""
    detail: FloatArray
    """(T, r) factor of the Gram matrix of the residuals, mean variance 1."""
    before: IntArray
    """(P,) frames that have a frame after them in the same chain."""
    first: IntArray
    """(C,) first frames of the chains."""
    scales: tuple[float, float, float]
    """Weights of the three likelihoods: their dimensions for the product itself, 1, 1, 1 / q for balance."""
    dim: int
    """Latent dimensions q."""
    likelihoods: tuple[LatentLikelihood, LatentLikelihood, LatentLikelihood] = field(init=False)
    """Where each of them is worked out; made from the rest."""

    def __post_init__(self) -> None:
        sizes = [Z.shape for Z in (self.skeleton, self.detail)] + [(len(self.before), self.dim)]
        pose, detail, path = (LatentLikelihood(n, r) for n, r in sizes)
        object.__setattr__(self, "likelihoods", (pose, detail, path))

    def split(self, theta: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        """Part a vector of all unknowns.

        Parameters
        ----------
        theta : (T q + 10,) float
            Latent points, then logarithms of the hyperparameters.

        Returns
        -------
        X : (T, q) ndarray
            Latent points.
        hyper : list of ndarray
            Hyperparameters of skeleton, detail and dynamics.
        """
        points = len(self.skeleton) * self.dim
        return theta[:points].reshape(-1, self.dim), np.split(theta[points:], np.cumsum(HYPER)[:-1])

    def __call__(self, theta: FloatArray) -> tuple[float, FloatArray]:
        """Evaluate.

        Parameters
        ----------
        theta : (T q + 10,) float
            Latent points, then logarithms of the hyperparameters.

        Returns
        -------
        value : float
            Minus the logarithm of the product, without constants; infinite where a kernel is singular.
        slope : (T q + 10,) ndarray
            Its gradient.
        """
        X, hyper = self.split(theta)
        of_pose, of_detail, of_path = self.likelihoods
        pose = of_pose(X, self.skeleton, hyper[0], self.scales[0])
        detail = of_detail(X, self.detail, hyper[1], self.scales[1])
        value, slope = pose.value + detail.value, pose.points + detail.points
        rates = [pose.hyper, detail.hyper, np.zeros(HYPER[2])]
        if len(self.before):
            path = of_path(X[self.before], np.asfortranarray(X[self.before + 1]), hyper[2], self.scales[2])
            value += path.value
            rates[2] = path.hyper
            slope[self.before] += path.points
            slope[self.before + 1] += path.outputs
        value += 0.5 * self.scales[2] * float((X[self.first] ** 2).sum())
        slope[self.first] += self.scales[2] * X[self.first]
        return value, np.concatenate([slope.ravel(), *rates])
