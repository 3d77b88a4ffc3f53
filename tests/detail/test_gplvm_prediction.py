"""Residuals at uncertain latent points, the way back from poses, and what blocks left out say of both."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.detail.gplvm import LatentProcess, fit_back_map, gram_factor, latent_plane, widen_variances


@pytest.fixture
def process(rng):
    X, Z = rng.normal(size=(9, 3)), rng.normal(size=(9, 4))
    Z -= Z.mean(axis=0)
    G = Z @ Z.T
    return LatentProcess(X, np.array([0.8, 0.7, 0.05]), G * 9 / np.trace(G))


def test_certain_points_get_the_usual_mean_and_variance(process, rng):
    points = rng.normal(size=(4, 3))
    a, g, s = process.hyper
    k = a * np.exp(-0.5 * g * np.square(points[:, None] - process.X).sum(axis=2))
    K = a * np.exp(-0.5 * g * np.square(process.X[:, None] - process.X).sum(axis=2)) + s * np.eye(9)
    assert_allclose(process.weights(points, np.zeros(4)), np.linalg.solve(K, k.T).T, atol=1e-10)
    usual = a + s - np.einsum("qt,qt->q", k, np.linalg.solve(K, k.T).T)
    assert_allclose(process.variance(points, np.zeros(4)), usual, atol=1e-10)


@pytest.mark.parametrize("unsure", [0.05, 0.4])
def test_uncertain_points_agree_with_sampling(process, rng, unsure):
    point = rng.normal(size=(1, 3))
    samples = point + np.sqrt(unsure) * rng.normal(size=(60_000, 3))
    W = process.weights(samples, np.zeros(len(samples)))
    inner = process.variance(samples[:4000], np.zeros(4000)).mean()
    outer = (W @ gram_factor(process.gram)).var(axis=0).sum()
    assert_allclose(process.weights(point, np.array([unsure]))[0], W.mean(axis=0), atol=6e-3)
    assert_allclose(process.variance(point, np.array([unsure])), inner + outer, rtol=0.03)


def test_hopeless_points_predict_the_mean_with_the_variance_of_the_prior(process):
    a, _, s = process.hyper
    far = np.full((1, 3), 1e3)
    assert_allclose(process.weights(far, np.zeros(1)), 0.0, atol=1e-12)
    assert_allclose(process.variance(far, np.zeros(1)), a + s)
    assert_allclose(process.weights(np.zeros((1, 3)), np.array([1e8])), 0.0, atol=1e-9)


def test_without_noise_the_training_is_met(process):
    exact = LatentProcess(process.X, np.array([0.8, 0.7, 1e-9]), process.gram)
    assert_allclose(exact.weights(process.X, np.zeros(9)), np.eye(9), atol=1e-5)
    assert exact.variance(process.X, np.zeros(9)).max() < 1e-6


def wave(T=60, end=9.0):
    t = np.linspace(0, end, T)
    Y = np.column_stack([np.sin(t), np.cos(t), 0.3 * np.sin(2 * t)])
    return Y, np.column_stack([np.sin(t + 0.4), np.cos(t)])


def test_back_map_finds_points_between_those_of_the_training():
    Y, X = wave()
    back = fit_back_map(Y[::2], np.zeros(3, int), X[::2])
    points, unsure = back(Y[1::2])
    assert np.abs(points - X[1::2])[:-1].max() < 0.02
    assert unsure.max() < 0.05


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_back_map_carries_units_of_both_sides(unit):
    Y, X = wave(30)
    points, unsure = fit_back_map(Y, np.zeros(3, int), X)(Y + 0.1)
    scaled, wide = fit_back_map(unit * Y, np.zeros(3, int), X / unit)(unit * (Y + 0.1))
    assert_allclose(scaled * unit, points, atol=2e-3)
    assert_allclose(wide * unit**2, unsure, rtol=0.05, atol=1e-5)


def test_foreign_poses_are_unsure():
    Y, X = wave()
    back = fit_back_map(Y, np.zeros(3, int), X)
    assert back(np.array([[4.0, -4.0, 3.0]]))[1] > 20 * back(Y)[1].max()


def test_blocks_left_out_widen_what_is_too_sure(rng):
    """Points that poses do not tell are believed by the back-map, refuted by blocks left out."""
    Y, X = wave(60, 40.0)
    back = fit_back_map(Y, np.zeros(3, int), X)
    D = X @ rng.normal(size=(2, 5)) + 0.1 * rng.normal(size=(60, 5))
    D -= D.mean(axis=0)
    G = D @ D.T
    good = LatentProcess(X, np.array([1.0, 0.3, 1e-2]), G * len(X) / np.trace(G))
    noise = rng.normal(size=(60, 40))
    noise -= noise.mean(axis=0)
    N = noise @ noise.T
    bad = LatentProcess(X, good.hyper, N * len(X) / np.trace(N))
    honest, foolish = (widen_variances(back, p, np.zeros(60, int)) for p in (good, bad))
    assert foolish.points == 3.0
    assert foolish.residuals > 5 * honest.residuals


def test_plane_shows_frames_in_the_light_and_places_far_away_in_the_dark(rng):
    _, X = wave()
    X = np.column_stack([X, 0.5 * X[:, 0] ** 2, 0.1 * X[:, 1]])
    D = X - X.mean(axis=0)
    process = LatentProcess(X, np.array([1.0, 1.0, 1e-3]), D @ D.T * 60 / np.trace(D @ D.T))
    plane = latent_plane(process, X[:3], size=30)
    assert plane.variance.shape == (30, 30) and plane.points.shape == (60, 2) and 0.5 < plane.share <= 1.0
    assert_allclose(plane.queries, plane.points[:3])
    row, column = (np.abs(axis - plane.points[10, i]).argmin() for i, axis in ((1, plane.y), (0, plane.x)))
    assert plane.variance[row, column] < 0.2 * plane.variance[0, 0]
