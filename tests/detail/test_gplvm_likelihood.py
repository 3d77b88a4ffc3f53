"""The joint likelihood of pose, detail and latent path: values, slopes, what it may and may not depend on."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import multivariate_normal

from tempose.detail.gplvm import SharedObjective, gram_factor, latent_start, train_latent, unit_gram
from tempose.detail.gplvm.likelihood import LatentLikelihood


def covariance(X, a, g, s, c=0.0):
    """Plain twin of the compiled covariance."""
    apart = np.square(X[:, None] - X).sum(axis=2)
    return a * np.exp(-0.5 * g * apart) + c * X @ X.T + s * np.eye(len(X))


def objective(rng, T=12, q=3, breaks=(5,), scales=(5.0, 7.0, 1.3)):
    before = np.array([t for t in range(T - 1) if t not in breaks])
    first = np.array([0, *(b + 1 for b in breaks)])
    Y, Z = (np.asfortranarray(rng.normal(size=(T, r))) for r in (5, 7))
    made = SharedObjective(Y, Z, before, first, scales, q)
    return made, np.concatenate([rng.normal(size=T * q), 0.5 * rng.normal(size=10) - 1])


@pytest.mark.parametrize("linear", [False, True])
def test_value_is_minus_the_log_density(rng, linear):
    X, Z = rng.normal(size=(8, 2)), rng.normal(size=(8, 5))
    hyper = np.array([0.9, 1.4, 0.2, 0.3])[: 4 if linear else 3]
    found = LatentLikelihood(8, 5)(X, np.asfortranarray(Z), np.log(hyper), 5.0).value
    density = multivariate_normal(np.zeros(8), covariance(X, *hyper)).logpdf(Z.T).sum()
    # columns weigh scale / D each; constants are left out
    scaled = LatentLikelihood(8, 5)(X, np.asfortranarray(Z / np.sqrt(5)), np.log(hyper), 5.0).value
    K = covariance(X, *hyper)
    assert_allclose(scaled, -density - 20 * np.log(2 * np.pi), rtol=1e-10)
    assert_allclose(
        found, 2.5 * (np.linalg.slogdet(K)[1] + np.trace(np.linalg.solve(K, Z @ Z.T))), rtol=1e-10
    )


def test_slopes_are_those_of_central_differences(rng):
    joint, theta = objective(rng)
    _, slope = joint(theta)
    h = 1e-5
    numeric = [(joint(theta + h * e)[0] - joint(theta - h * e)[0]) / (2 * h) for e in np.eye(len(theta))]
    assert_allclose(slope, numeric, rtol=1e-6, atol=1e-6)


def test_second_call_does_not_remember_the_first(rng):
    joint, theta = objective(rng)
    value, slope = joint(theta)
    joint(theta + 0.3)
    again = joint(theta)
    assert again[0] == value
    assert_allclose(again[1], slope, rtol=0, atol=0)


def test_clips_are_independent_given_their_points_in_the_dynamics(rng):
    """The path of a clip says nothing of the first point of the next, which has a prior of its own."""
    joint, theta = objective(rng, breaks=(5,))
    unbroken = SharedObjective(
        joint.skeleton, joint.detail, np.arange(11), np.array([0]), joint.scales, joint.dim
    )
    X, (_, _, dynamics) = joint.split(theta)
    a, g, s, c = np.exp(dynamics)

    def path(before):
        K = covariance(X[before], a, g, s, c)
        out = X[before + 1]
        return 0.5 * 1.3 * (np.linalg.slogdet(K)[1] + np.trace(np.linalg.solve(K, out @ out.T)))

    prior = 0.5 * 1.3 * float(X[6] @ X[6])
    difference = path(np.delete(np.arange(11), 5)) + prior - path(np.arange(11))
    assert_allclose(joint(theta)[0] - unbroken(theta)[0], difference, rtol=1e-9)


def test_vertices_enter_by_inner_products_only(rng):
    """30 coordinates and 3000 with the same inner products have one likelihood."""
    Y = rng.normal(size=(9, 30))
    turn, _ = np.linalg.qr(rng.normal(size=(3000, 30)))
    X, hyper = rng.normal(size=(9, 2)), np.log([1.0, 0.7, 0.1])
    few, many = (gram_factor(rows @ rows.T / 30) for rows in (Y, Y @ turn.T))
    values = [LatentLikelihood(*Z.shape)(X, np.asfortranarray(Z), hyper, 1.0).value for Z in (few, many)]
    assert_allclose(values[0], values[1], rtol=1e-10)


def test_factor_gives_the_matrix_back_and_no_more_columns_than_its_rank(rng):
    Y = rng.normal(size=(10, 4))
    Z = gram_factor(Y @ Y.T)
    assert Z.shape == (10, 4)
    assert_allclose(Z @ Z.T, Y @ Y.T, atol=1e-12)


def test_start_spans_the_widest_directions_and_pads_with_nothing(rng):
    Y = rng.normal(size=(10, 2)) * [3.0, 1.0]
    Y -= Y.mean(axis=0)
    X = latent_start(Y @ Y.T, 4)
    assert X.shape == (10, 4)
    assert_allclose(X[:, 2:], 0.0)
    assert_allclose(X @ X.T / np.trace(X @ X.T), Y @ Y.T / np.trace(Y @ Y.T), atol=1e-12)


def test_training_lowers_the_objective_and_keeps_noise_above_its_floor(rng):
    t = np.linspace(0, 6, 30)
    Y = np.column_stack([np.sin(t), np.cos(t)])
    gram, _ = unit_gram((Y - Y.mean(axis=0)) @ (Y - Y.mean(axis=0)).T)
    start = latent_start(gram, 2)
    fits = [
        train_latent(gram, gram, start, np.zeros(30, int), scales=(1, 1, 0.5), iterations=k, noise_floor=1e-3)
        for k in (5, 40)
    ]
    assert fits[1].value < fits[0].value
    assert fits[1].detail[2] >= 1e-3 * (1 - 1e-12)
    assert fits[0].iterations == 5 and not fits[0].converged


def test_progress_may_cancel_the_training(rng):
    gram, _ = unit_gram(np.eye(8) - 1 / 8)

    def stop(done, total, stage):
        raise KeyboardInterrupt(stage)

    with pytest.raises(KeyboardInterrupt, match="latent model"):
        train_latent(gram, gram, latent_start(gram, 2), np.zeros(8, int), scales=(1, 1, 1), progress=stop)


def test_training_pairs_no_frames_of_two_clips(rng):
    """The value found is that of the likelihood whose dynamics leave the step between clips out."""
    Y = rng.normal(size=(20, 3))
    Y -= Y.mean(axis=0)
    gram, _ = unit_gram(Y @ Y.T)
    scales = (1.0, 1.0, 0.5)
    fit = train_latent(
        gram, gram, latent_start(gram, 2), np.repeat([4, 9], [12, 8]), scales=scales, iterations=5
    )
    Z = np.asfortranarray(gram_factor(gram))
    joint = SharedObjective(Z, Z, np.delete(np.arange(19), 11), np.array([0, 12]), scales, 2)
    hyper = np.log(np.concatenate([fit.skeleton, fit.detail, fit.dynamics]))
    assert_allclose(joint(np.concatenate([fit.X.ravel(), hyper]))[0], fit.value, rtol=1e-9)
