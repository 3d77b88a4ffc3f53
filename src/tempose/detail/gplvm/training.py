"""Latent points and hyperparameters of the shared model, from Gram matrices alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from tempose.detail.gplvm.grams import gram_factor
from tempose.detail.gplvm.objective import SharedObjective
from tempose.regression import one_blas_thread
from tempose.typing import FloatArray, IntArray, Progress, silent

_START = np.log([0.7, 0.7, 0.05])
_DYNAMICS = np.log([0.5, 0.5, 0.02, 0.5])
_LOOSE = (np.log(1e-4), np.log(1e4))
_MOST_NOISE = np.log(10.0)


@dataclass(frozen=True, eq=False)
class LatentFit:
    """The trained shared model."""

    X: FloatArray
    """(T, q) latent points."""
    skeleton: FloatArray
    """(3,) variance, rate and noise of the kernel from latent points to poses of variance 1."""
    detail: FloatArray
    """(3,) variance, rate and noise of the kernel from latent points to residuals of variance 1."""
    dynamics: FloatArray
    """(4,) variance, rate, noise and linear variance of the kernel from a latent point to the next."""
    value: float
    """Minus the logarithm of the joint likelihood, without constants."""
    iterations: int
    """Steps taken."""
    converged: bool
    """Whether the slope vanished before the steps were used up."""


def latent_start(gram: FloatArray, dim: int) -> FloatArray:
    """Begin with principal components.

    Parameters
    ----------
    gram : (T, T) float
        Of centred data.
    dim : int
        Latent dimensions q.

    Returns
    -------
    (T, q) ndarray
        The q widest components in their proportions, of mean variance 1 together; zeros beyond the rank.
    """
    X = gram_factor(gram)[:, :dim]
    X = np.pad(X, ((0, 0), (0, dim - X.shape[1])))
    return X / max(float(np.sqrt(np.mean(X**2))), 1e-300)


def train_latent(
    skeleton: FloatArray,
    detail: FloatArray,
    start: FloatArray,
    chains: IntArray,
    *,
    scales: tuple[float, float, float],
    iterations: int = 100,
    noise_floor: float = 1e-4,
    progress: Progress = silent,
) -> LatentFit:
    """Maximise the joint likelihood of poses, residuals and the latent path by L-BFGS.

    Parameters
    ----------
    skeleton : (T, T) float
        Gram matrix of the poses, trace T.
    detail : (T, T) float
        Gram matrix of the residuals, trace T.
    start : (T, q) float
        Latent points to begin with.
    chains : (T,) int
        Which clip every frame is from: dynamics never pair frames of two.
    scales : tuple of 3 float
        Weights of the three likelihoods, see `SharedObjective`.
    iterations : int, default 100
        Largest number of steps. More fit the training ever closer and the rest worse.
    noise_floor : float, default 1e-4
        Least noise, as part of the variance.
    progress : Progress
        Told about every step.

    Returns
    -------
    LatentFit
        The best found.
    """
    T, q = start.shape
    same = np.diff(chains) == 0
    first = np.concatenate([[0], np.flatnonzero(~same) + 1])
    factors = [np.asfortranarray(gram_factor(gram)) for gram in (skeleton, detail)]
    objective = SharedObjective(factors[0], factors[1], np.flatnonzero(same), first, scales, q)
    theta = np.concatenate([start.ravel(), _START, _START, _DYNAMICS])
    noise = (np.log(noise_floor), _MOST_NOISE)
    bounds = [(None, None)] * (T * q) + 2 * [_LOOSE, _LOOSE, noise] + [_LOOSE, _LOOSE, noise, _LOOSE]
    done = 0

    def step(_: FloatArray) -> None:
        nonlocal done
        done += 1
        progress(done, iterations, "latent model")

    with one_blas_thread():
        found = minimize(
            objective,
            theta,
            jac=True,
            method="L-BFGS-B",
            bounds=bounds,
            callback=step,
            options={"maxiter": iterations, "maxfun": 2 * iterations + 20},
        )
    X, hyper = objective.split(found.x)
    a, b, c = (np.exp(h) for h in hyper)
    return LatentFit(X, a, b, c, float(found.fun), int(found.nit), bool(found.success))
