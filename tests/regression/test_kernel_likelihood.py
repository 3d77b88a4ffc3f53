"""Kernels and their likelihood: the closed form of a Gaussian, its derivative, what it must not depend on."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import multivariate_normal

from tempose.regression import GramLikelihood, GroupDistances, Kernel, default_starts, fit_kernel

GROUPS = np.array([0, 0, 1, 2, 2, 2])


def observations(rng, T=14, d=5):
    return rng.standard_normal((T, 6)) + 3.0, rng.standard_normal((T, d))


def some_kernel(rng):
    return Kernel(*rng.uniform(0.2, 1.5, 3), rng.uniform(0.05, 0.5, 3), GROUPS)


def written_out(kernel, a, b):
    distance = product = 0.0
    for p, g in enumerate(kernel.groups):
        distance += kernel.precision[g] * (a[p] - b[p]) ** 2
        product += kernel.precision[g] * a[p] * b[p]
    return kernel.smooth * np.exp(-distance / 2) + kernel.linear * product


def test_kernel_is_its_formula(rng):
    kernel, (X, _) = some_kernel(rng), observations(rng)
    expected = [[written_out(kernel, a, b) for b in X[:4]] for a in X]
    assert_allclose(kernel(X, X[:4]), expected, rtol=1e-12)
    assert_allclose(kernel.diagonal(X), [written_out(kernel, a, a) for a in X], rtol=1e-12)


def test_kernel_comes_back_from_its_logarithms(rng):
    kernel = some_kernel(rng)
    again = Kernel.from_logarithms(kernel.logarithms, GROUPS)
    assert_allclose(again.logarithms, kernel.logarithms, atol=1e-14)
    assert_allclose(again.noise, kernel.noise)


def test_likelihood_is_that_of_a_gaussian(rng):
    X, Y = observations(rng)
    kernel = some_kernel(rng)
    value, _ = GramLikelihood(GroupDistances(X, GROUPS), Y @ Y.T / Y.shape[1])(kernel.logarithms)
    K = kernel(X, X) + kernel.noise * np.eye(len(X))
    true = -multivariate_normal(np.zeros(len(X)), K).logpdf(Y.T).mean()
    assert_allclose(value + 0.5 * len(X) * np.log(2 * np.pi), true, rtol=1e-10)


def test_gradient_is_that_of_finite_differences(rng):
    X, Y = observations(rng)
    likelihood = GramLikelihood(GroupDistances(X, GROUPS), Y @ Y.T / Y.shape[1])
    at, h = some_kernel(rng).logarithms, 1e-5
    steps = h * np.eye(len(at))
    slopes = [(likelihood(at + e)[0] - likelihood(at - e)[0]) / (2 * h) for e in steps]
    assert_allclose(likelihood(at)[1], slopes, rtol=1e-6, atol=1e-7)


def test_likelihood_does_not_depend_on_the_number_of_outputs(rng):
    X, Y = observations(rng)
    distances = GroupDistances(X, GROUPS)
    at = some_kernel(rng).logarithms
    turned = Y @ np.linalg.qr(rng.standard_normal((40, 5)))[0].T
    once = GramLikelihood(distances, Y @ Y.T)(at)[0]
    assert_allclose(GramLikelihood(distances, turned @ turned.T)(at)[0], once, rtol=1e-12)


def test_singular_covariance_is_infinitely_unlikely():
    X = np.zeros((5, 6))
    likelihood = GramLikelihood(GroupDistances(X, GROUPS), np.eye(5))
    logarithms = np.log([1.0, 1.0, 1e-300, 1.0, 1.0, 1.0])
    value, gradient = likelihood(logarithms)
    assert value == np.inf and np.isfinite(gradient).all()


def test_fit_is_a_stationary_point_and_better_than_its_starts(rng):
    X, Y = observations(rng, 30, 8)
    S = Y @ Y.T
    S *= len(X) / np.trace(S)
    fit = fit_kernel(X, GROUPS, S, iterations=500)
    likelihood = GramLikelihood(GroupDistances(X, GROUPS), S)
    assert fit.converged
    for start in default_starts(X, GROUPS):
        assert fit.value <= likelihood(start.logarithms)[0]
    assert fit.kernel.noise >= 1e-3 * (1 - 1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_fit_follows_the_unit_of_the_inputs(unit):
    rng = np.random.default_rng(1)
    X = rng.standard_normal((25, 6))
    Y = np.column_stack([np.sin(X[:, 0]), X[:, 1]])
    S = (Y - Y.mean(axis=0)) @ (Y - Y.mean(axis=0)).T
    S *= len(X) / np.trace(S)
    near = fit_kernel(X, GROUPS, S, iterations=40)
    far = fit_kernel(unit * X, GROUPS, S, iterations=40)
    assert_allclose(far.value, near.value, rtol=1e-4)
    assert_allclose(far.kernel.precision[0] * unit**2, near.kernel.precision[0], rtol=0.05)


def test_prior_holds_the_scales_of_the_start(rng):
    X, Y = observations(rng, 30, 8)
    S = Y @ Y.T
    S *= len(X) / np.trace(S)
    start = default_starts(X, GROUPS)[0]
    free, held = (
        fit_kernel(X, GROUPS, S, starts=[start], prior=prior).kernel.precision for prior in (0.0, 1e6)
    )
    assert_allclose(held, start.precision, rtol=1e-3)
    assert np.abs(np.log(free / start.precision)).max() > 0.1


def test_groups_that_say_nothing_get_long_scales():
    rng = np.random.default_rng(3)
    X = rng.standard_normal((80, 6))
    Y = np.sin(2 * X[:, [2]]) @ rng.standard_normal((1, 4))
    S = (Y - Y.mean(axis=0)) @ (Y - Y.mean(axis=0)).T
    S *= len(X) / np.trace(S)
    precision = fit_kernel(X, GROUPS, S).kernel.precision
    assert precision[1] > 100 * precision[0] and precision[1] > 100 * precision[2]
