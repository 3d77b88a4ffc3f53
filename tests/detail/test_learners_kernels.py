"""Learners mix training residuals whatever the vertices; history stays inside a clip; hard input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.detail.evaluation import mixed_residuals
from tempose.detail.learners import (
    MeanLearner,
    NearestLearner,
    PlainGaussianProcess,
    RegionalGaussianProcess,
    RidgeLearner,
)
from tempose.detail.learners.calibration import variance_factor
from tempose.detail.learners.features import Features, TwoFrames
from tempose.detail.learners.memory import frame_ages, past
from tempose.detail.regions import region_grams
from tempose.detail.training import Inputs, Training
from tempose.regression import GaussianProcess, Kernel

LEARNERS = [
    MeanLearner(),
    NearestLearner(),
    RidgeLearner(),
    PlainGaussianProcess(),
    RegionalGaussianProcess(),
]
GAUSSIAN = LEARNERS[3:]


def swing(rng, T=60, K=2, E=0):
    time = np.arange(T)[:, None, None] / 30
    angles = 0.4 * np.sin(2 * np.pi * time * rng.uniform(0.8, 1.2, (1, K, 3)) + rng.uniform(0, 6, (K, 3)))
    velocity = np.diff(angles, axis=0, prepend=angles[:1])
    velocity[0] = velocity[1]
    return Inputs(angles, velocity, rng.standard_normal((T, E)), np.zeros(T, dtype=int))


def cloth(rng, inputs, n=12, R=2):
    T = len(inputs)
    seen = np.concatenate([inputs.angles, 5 * inputs.velocity], axis=1).reshape(T, -1)
    D = np.tanh(seen @ rng.standard_normal((seen.shape[1], 3 * n))).reshape(T, n, 3) * 0.02 + 0.01
    shares = rng.dirichlet(np.ones(R), n)
    return D, shares


@pytest.fixture
def case(rng):
    inputs = swing(rng)
    D, shares = cloth(rng, inputs)
    return Training(inputs, *region_grams(D, shares)), D, shares


@pytest.mark.parametrize("learner", LEARNERS, ids=lambda learner: learner.name)
def test_mixture_has_the_promised_shape(learner, case):
    training, _, _ = case
    mixture = learner.fit(training).mix(training.inputs.take(np.arange(5, 12)))
    assert mixture.weights.shape[0] in (1, 2) and mixture.weights.shape[1:] == (7, 60)
    assert mixture.variance.shape == (7, mixture.weights.shape[0])
    assert (mixture.variance > 0).all() and np.isfinite(mixture.weights).all()


@pytest.mark.parametrize("learner", LEARNERS, ids=lambda learner: learner.name)
@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_residuals_in_another_unit_are_mixed_alike(learner, case, unit):
    training, _, _ = case
    scaled = replace(training, grams=unit**2 * training.grams)
    some = training.inputs.take(np.arange(10))
    once, again = learner.fit(training).mix(some), learner.fit(scaled).mix(some)
    # descents amplify rounding where scales hardly matter
    assert_allclose(again.weights, once.weights, atol=2e-4)
    assert_allclose(again.variance, unit**2 * once.variance, rtol=1e-2)


@pytest.mark.parametrize("learner", LEARNERS, ids=lambda learner: learner.name)
def test_a_rotation_of_the_vertices_rotates_the_prediction(learner, case, rng):
    training, D, shares = case
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    turned = Training(training.inputs, *region_grams(D @ turn, shares))
    once = mixed_residuals(D, shares, learner.fit(training).mix(training.inputs))
    again = mixed_residuals(D @ turn, shares, learner.fit(turned).mix(training.inputs))
    assert np.linalg.norm(again - once @ turn) < 0.01 * np.linalg.norm(once)


@pytest.mark.parametrize("learner", GAUSSIAN, ids=lambda learner: learner.name)
def test_training_frames_come_back_nearly(learner, case):
    training, D, shares = case
    found = mixed_residuals(D, shares, learner.fit(training).mix(training.inputs))
    assert np.linalg.norm(found - D) < 0.05 * np.linalg.norm(D - D.mean(axis=0))


@pytest.mark.parametrize("learner", LEARNERS, ids=lambda learner: learner.name)
def test_no_residual_gives_no_residual_and_no_variance(learner, case):
    training, D, shares = case
    nothing = replace(training, grams=np.zeros_like(training.grams))
    mixture = learner.fit(nothing).mix(training.inputs)
    assert_allclose(mixture.variance, 0, atol=1e-20)
    assert_allclose(mixed_residuals(0 * D, shares, mixture), 0)


@pytest.mark.parametrize("learner", LEARNERS, ids=lambda learner: learner.name)
@pytest.mark.parametrize("T", [1, 2, 3, 5])
def test_few_frames_and_constant_frames_are_survived(learner, rng, T):
    inputs = swing(rng, max(T, 2)).take(np.arange(T))
    D, shares = cloth(rng, inputs)
    for seen in (inputs, replace(inputs, angles=0 * inputs.angles, velocity=0 * inputs.velocity)):
        mixture = learner.fit(Training(seen, *region_grams(D, shares))).mix(seen)
        assert np.isfinite(mixture.weights).all() and np.isfinite(mixture.variance).all()


@pytest.mark.parametrize("learner", GAUSSIAN, ids=lambda learner: learner.name)
def test_a_residual_that_never_changes_is_the_mean_and_certain(learner, case):
    training, D, shares = case
    still = np.repeat(D[:1], 60, axis=0)
    mixture = learner.fit(Training(training.inputs, *region_grams(still, shares))).mix(training.inputs)
    assert_allclose(mixture.weights, 0)
    assert mixture.variance.max() < 1e-12 * np.square(still).mean()


def test_a_region_without_vertices_predicts_the_mean_and_leaves_the_others_alone(case, rng):
    training, D, shares = case
    wider = np.column_stack([shares[:, :1], np.zeros(len(shares)), shares[:, 1:]])
    one = RegionalGaussianProcess().fit(training).mix(training.inputs)
    other = RegionalGaussianProcess().fit(Training(training.inputs, *region_grams(D, wider)))
    mixture = other.mix(training.inputs)
    assert_allclose(mixture.weights[1], 0)
    assert_allclose(mixture.weights[[0, 2]], one.weights, atol=2e-4)


def test_nearest_finds_the_frame_itself(case):
    training, _, _ = case
    weights = NearestLearner().fit(training).mix(training.inputs).weights[0]
    assert_allclose(weights, np.eye(60))


def test_a_linear_law_is_found_by_ridge(rng):
    inputs = swing(rng, 120, K=1)
    D = (inputs.angles.reshape(120, -1) @ rng.standard_normal((3, 30))).reshape(120, 10, 3)
    training = Training(inputs, *region_grams(D, np.ones((10, 1))))
    train, test = np.arange(80), np.arange(80, 120)
    mixture = RidgeLearner().fit(training.take(train)).mix(inputs.take(test))
    wrong = mixed_residuals(D[train], np.ones((10, 1)), mixture) - D[test]
    assert np.linalg.norm(wrong) < 0.02 * np.linalg.norm(D[test])


def test_inducing_points_come_near_to_all_frames(case):
    training, D, shares = case
    full = mixed_residuals(D, shares, RegionalGaussianProcess().fit(training).mix(training.inputs))
    few = RegionalGaussianProcess(inducing=40).fit(training).mix(training.inputs)
    all_of_them = RegionalGaussianProcess(inducing=59).fit(training).mix(training.inputs)
    assert np.linalg.norm(mixed_residuals(D, shares, few) - full) < 0.15 * np.linalg.norm(full)
    assert np.linalg.norm(mixed_residuals(D, shares, all_of_them) - full) < 0.02 * np.linalg.norm(full)


def test_history_never_crosses_clips():
    chains = np.array([0, 0, 0, 4, 4, 1, 1, 1])
    values = np.arange(8.0)
    assert_allclose(frame_ages(chains), [0, 1, 2, 0, 1, 0, 1, 2])
    assert_allclose(past(values, chains, 1), [0, 0, 1, 3, 3, 5, 5, 6])
    assert_allclose(past(values, chains, 9), [0, 0, 0, 3, 3, 5, 5, 5])
    assert_allclose(past(values, chains, 0), values)


def test_blocks_of_features_have_variance_one(rng):
    inputs = swing(rng, E=3)
    features = Features.of(inputs, (0, 2))
    X, blocks, groups = features(inputs), features.blocks(inputs), features.groups(inputs)
    assert X.shape == (60, 6 + 2 * 6 + 3) and blocks.shape == groups.shape == (21,)
    variance = np.bincount(blocks, X.var(axis=0))
    assert_allclose(variance[[0, 1]], 1)
    assert_allclose(X[:, blocks == 3].var(axis=0), 1)
    assert_allclose(X[2:, blocks == 2], X[:-2, blocks == 1])
    # a group for each joint's angle and latest velocity, one for the older velocities, one for the rest
    assert groups.max() + 1 == 2 + 2 + 1 + 1
    assert all(len(np.unique(blocks[groups == g])) == 1 for g in range(6))


def test_an_unknown_past_is_as_wrong_as_it_is_where_it_is_known(rng):
    inputs = swing(rng)
    features = Features.of(inputs, (0, 2))
    unknown, blocks = features.unknown(inputs), features.blocks(inputs)
    old = features.groups(inputs)[blocks == 2][0]
    moved = inputs.velocity.reshape(60, -1) / features.scales[1]
    for age in (0, 1):
        off = np.square(moved[:-2] - moved[2 - age : 60 - age]).sum(axis=1).mean()
        assert_allclose(unknown[age, old], off)
    assert_allclose(unknown[2:], 0)
    assert_allclose(np.delete(unknown, old, axis=1), 0)


def test_two_frames_are_the_frame_and_the_one_before(rng):
    inputs = swing(rng)
    X = TwoFrames()(inputs)
    assert_allclose(X[1:, 6:], X[:-1, :6], atol=1e-15)


def test_variance_factor_is_that_of_processes_made_without_the_block(case):
    training, _, _ = case
    S = training.centred_gram
    S *= len(S) / np.trace(S)
    X = TwoFrames()(training.inputs)
    kernel = Kernel(0.7, 0.3, 0.05, np.array([0.8]), np.zeros(X.shape[1], dtype=int))
    wrong = said = 0.0
    for test in np.array_split(np.arange(60), 5):
        train = np.setdiff1d(np.arange(60), np.arange(test[0] - 1, test[-1] + 2))
        process = GaussianProcess(kernel, X[train])
        lines = np.zeros((len(test), 60))
        lines[np.arange(len(test)), test] = 1
        lines[:, train] -= process.weights(X[test])
        wrong += np.trace(lines @ S @ lines.T)
        said += process.variance(X[test]).sum()
    factor = variance_factor(kernel, X, S, training.inputs.chains)
    assert_allclose(factor, np.clip(wrong / said, 0.3, 10), rtol=1e-6)


def test_predicted_variances_carry_the_factor(case):
    training, _, _ = case
    predictor = PlainGaussianProcess().fit(training)
    S = training.centred_gram
    spread = np.trace(S) / (60 * training.sizes.sum())
    factor = variance_factor(predictor.kernels[0], predictor.X, S / S.trace() * 60, training.inputs.chains)
    assert factor != pytest.approx(1.0, rel=0.01)
    assert_allclose(predictor.spreads, factor * spread, rtol=1e-9)


def test_frames_with_an_unknown_past_count_less_where_the_past_matters(rng):
    inputs = replace(swing(rng, 90), chains=np.repeat([0, 1], 45))
    late = past(inputs.velocity, np.zeros(90, dtype=int), 6).reshape(90, -1)
    D = (late @ rng.standard_normal((6, 30))).reshape(90, 10, 3)
    predictor = RegionalGaussianProcess().fit(Training(inputs, *region_grams(D, np.ones((10, 1)))))
    ages = frame_ages(inputs.chains)
    assert (predictor.vague[0, ages >= 12] == 0).all()
    assert (predictor.vague[0, ages < 6] > 10 * predictor.kernels[0].noise).all()
    weights = np.abs(predictor.mix(inputs).weights[0])
    assert weights[:, ages < 6].mean() < 0.5 * weights[:, ages >= 12].mean()


def test_the_same_training_gives_the_same_predictor(case):
    training, _, _ = case
    a, b = (RegionalGaussianProcess().fit(training).mix(training.inputs) for _ in range(2))
    assert (a.weights == b.weights).all() and (a.variance == b.variance).all()


def test_thousands_of_frames_are_learned_through_some(rng):
    inputs = swing(rng, 1000, K=1)
    D, shares = cloth(rng, inputs, 6, 1)
    training = Training(inputs, *region_grams(D, shares))
    train, test = np.arange(800), np.arange(800, 1000)
    mixture = RegionalGaussianProcess(inducing=100).fit(training.take(train)).mix(inputs.take(test))
    wrong = mixed_residuals(D[train], shares, mixture) - D[test]
    assert np.linalg.norm(wrong) < 0.1 * np.linalg.norm(D[test] - D[train].mean(axis=0))
