"""Predictions of Gaussian processes: conditional Gaussians, few inducing points against all, many at once."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.regression import GaussianProcess, InducingProcess, Kernel, ProcessBank, choose_inducing

GROUPS = np.repeat(np.arange(3), 2)


def kernels(rng, R=3):
    return [Kernel(*rng.uniform(0.2, 1.0, 3), rng.uniform(0.1, 0.5, 3), GROUPS) for _ in range(R)]


@pytest.fixture
def X(rng):
    return rng.standard_normal((25, 6)) + 2.0


@pytest.fixture
def queries(rng):
    return rng.standard_normal((7, 6)) + 1.0


def test_prediction_is_the_conditional_gaussian(rng, X, queries):
    kernel = kernels(rng, 1)[0]
    vague = rng.uniform(0, 1, len(X))
    joint = np.vstack([X, queries])
    K = kernel(joint, joint) + kernel.noise * np.eye(len(joint))
    K[: len(X), : len(X)] += np.diag(vague)
    process = GaussianProcess(kernel, X, vague)
    for q in range(len(queries)):
        some = np.r_[: len(X), len(X) + q]
        P = np.linalg.inv(K[np.ix_(some, some)])
        assert_allclose(process.weights(queries)[q], -P[-1, :-1] / P[-1, -1], rtol=1e-8)
        assert_allclose(process.variance(queries)[q], 1 / P[-1, -1], rtol=1e-8)


def test_without_noise_observations_are_met_and_certain(X):
    kernel = Kernel(1.0, 0.0, 1e-10, np.full(3, 5.0), GROUPS)
    process = GaussianProcess(kernel, X)
    assert_allclose(process.weights(X), np.eye(len(X)), atol=1e-6)
    assert process.variance(X).max() < 1e-6


def test_far_away_the_prior_is_left(X):
    kernel = Kernel(0.7, 0.0, 0.1, np.full(3, 1.0), GROUPS)
    process = GaussianProcess(kernel, X)
    assert_allclose(process.weights(X[:1] + 100), 0, atol=1e-12)
    assert_allclose(process.variance(X[:1] + 100), 0.8)


def test_variance_is_between_noise_and_prior(rng, X, queries):
    for kernel in kernels(rng):
        for process in (GaussianProcess(kernel, X), InducingProcess(kernel, X, X[::4])):
            variance = process.variance(queries)
            assert (variance >= kernel.noise).all()
            assert (variance <= kernel.diagonal(queries) + kernel.noise + 1e-9).all()


def test_all_points_inducing_is_the_dense_process(rng, X, queries):
    vague = rng.uniform(0, 1, len(X))
    for kernel in kernels(rng):
        dense, seen = GaussianProcess(kernel, X, vague), InducingProcess(kernel, X, X, vague)
        assert_allclose(seen.weights(queries), dense.weights(queries), atol=1e-7)
        assert_allclose(seen.variance(queries), dense.variance(queries), atol=1e-7)


def test_inducing_mean_is_the_low_rank_process(rng, X, queries):
    kernel = kernels(rng, 1)[0]
    Z = X[::3]
    inner = np.linalg.inv(kernel(Z, Z))
    Q = kernel(X, Z) @ inner @ kernel(Z, X)
    low = kernel(queries, Z) @ inner @ kernel(Z, X)
    expected = low @ np.linalg.inv(Q + kernel.noise * np.eye(len(X)))
    assert_allclose(InducingProcess(kernel, X, Z).weights(queries), expected, atol=1e-7)


def test_more_inducing_points_come_nearer_to_the_dense_process():
    rng = np.random.default_rng(0)
    t = np.sort(rng.uniform(0, 10, 400))[:, None]
    kernel = Kernel(1.0, 0.0, 0.01, np.array([1.0]), np.zeros(1, dtype=int))
    dense = GaussianProcess(kernel, t).weights(t[::7])
    off = [
        np.linalg.norm(InducingProcess(kernel, t, t[choose_inducing(kernel, t, m)]).weights(t[::7]) - dense)
        for m in (5, 15, 30)
    ]
    assert off[0] > 3 * off[1] > 30 * off[2]
    assert off[2] < 1e-3 * np.linalg.norm(dense)


def test_inducing_points_avoid_repeats():
    X = np.repeat(np.arange(6.0), 5)[:, None]
    kernel = Kernel(1.0, 0.0, 0.01, np.array([1.0]), np.zeros(1, dtype=int))
    chosen = choose_inducing(kernel, X, 20)
    assert len(chosen) == 6 and len(np.unique(X[chosen])) == 6
    assert (np.diff(chosen) > 0).all()


@pytest.mark.parametrize("inducing", [None, np.arange(0, 25, 3)])
@pytest.mark.parametrize("vague", [False, True])
def test_bank_is_its_processes_one_by_one(rng, X, queries, inducing, vague):
    several = kernels(rng)
    extra = rng.uniform(0, 1, (3, len(X))) if vague else None
    weights, variance = ProcessBank(several, X, inducing, extra).query(queries)
    for r, kernel in enumerate(several):
        own = None if extra is None else extra[r]
        if inducing is None:
            process = GaussianProcess(kernel, X, own)
        else:
            process = InducingProcess(kernel, X, X[inducing], own)
        assert_allclose(weights[r], process.weights(queries), atol=1e-9)
        assert_allclose(variance[r], process.variance(queries), atol=1e-9)


def test_singular_covariance_says_to_raise_the_noise():
    kernel = Kernel(1.0, 0.0, 0.0, np.ones(1), np.zeros(1, dtype=int))
    with pytest.raises(ValueError, match="raise the noise"):
        GaussianProcess(kernel, np.zeros((3, 1)))
