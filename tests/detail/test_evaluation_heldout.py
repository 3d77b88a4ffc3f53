"""Errors from inner products against errors of vertices; the mean is taken where nothing can be learned."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.detail.evaluation import (
    Score,
    choose_learner,
    cross_validate,
    evaluate,
    gram_errors,
    mixed_residuals,
    rank_correlation,
)
from tempose.detail.learners import MeanLearner, PlainGaussianProcess, RidgeLearner
from tempose.detail.regions import region_grams
from tempose.detail.training import Inputs, Mixture, Training


@pytest.fixture
def case(rng):
    T, n = 40, 12
    angles = np.cumsum(rng.standard_normal((T, 3, 3)), axis=0) * 0.1
    velocity = np.diff(angles, axis=0, prepend=angles[:1])
    inputs = Inputs(angles, velocity, np.zeros((T, 0)), np.zeros(T, dtype=int))
    D = (angles.reshape(T, -1) @ rng.standard_normal((9, 3 * n))).reshape(T, n, 3) + 0.3
    shares = rng.dirichlet(np.ones(2), n)
    return Training(inputs, *region_grams(D, shares)), D, shares


def test_gram_errors_are_those_of_the_vertices(case, rng):
    training, D, shares = case
    train, test = np.r_[:10, 20:40], np.arange(12, 18)
    weights = rng.standard_normal((2, 6, 30))
    found = gram_errors(training.grams, weights, train, test)
    mean = D[train].mean(axis=0)
    for r in range(2):
        wrong = mean + np.einsum("qt,tnc->qnc", weights[r], D[train] - mean) - D[test]
        assert_allclose(found[:, r], np.square(wrong).sum(axis=2) @ shares[:, r], rtol=1e-9)


def test_blended_regions_err_at_most_as_much_as_gram_errors_say(case, rng):
    training, D, shares = case
    train, test = np.arange(30), np.arange(30, 40)
    weights = rng.standard_normal((2, 10, 30)) / 30
    mixture = Mixture(weights, np.ones((10, 2)))
    exact = np.square(mixed_residuals(D[train], shares, mixture) - D[test]).sum(axis=(1, 2))
    assert (exact <= gram_errors(training.grams, weights, train, test).sum(axis=1) * (1 + 1e-12)).all()


def test_one_mixture_for_all_is_the_same_with_and_without_regions(case, rng):
    _, D, shares = case
    weights = rng.standard_normal((1, 4, 40))
    one = mixed_residuals(D, shares, Mixture(weights, np.ones((4, 1))))
    each = mixed_residuals(D, shares, Mixture(np.repeat(weights, 2, axis=0), np.ones((4, 2))))
    assert_allclose(each, one, atol=1e-9)


def test_evaluation_of_the_mean_by_hand(case):
    training, D, shares = case
    train, test = np.arange(30), np.arange(32, 40)
    found = evaluate(MeanLearner(), training, train, test)
    wrong = D[test] - D[train].mean(axis=0)
    assert_allclose(found.errors, np.sqrt(np.square(wrong).sum(axis=2).mean(axis=1)))
    spread = np.square(D[train] - D[train].mean(axis=0)).mean()
    assert_allclose(found.calibration, np.sqrt(3 * spread) / found.rms)
    assert found.spearman == 0.0
    again = evaluate(MeanLearner(), training, train, test, D=D, shares=shares)
    assert_allclose(again.errors, found.errors)


def test_what_came_before_a_block_is_known_to_the_learner(case):
    training, _, _ = case

    class Recorder:
        name = "recorder"

        def fit(self, training):
            self.T = len(training.inputs)
            return self

        def mix(self, inputs):
            self.seen = inputs
            return Mixture(np.zeros((1, len(inputs), self.T)), np.arange(1.0, len(inputs) + 1)[:, None])

    recorder = Recorder()
    found = evaluate(recorder, training, np.arange(20), np.arange(35, 40))
    assert_allclose(recorder.seen.angles, training.inputs.angles[3:40])
    assert_allclose(found.predicted**2 / 3, np.arange(33.0, 38.0))


def test_frames_trained_on_may_not_be_tested(case):
    with pytest.raises(ValueError, match="must not share frames, got 5"):
        evaluate(MeanLearner(), case[0], np.arange(6), np.arange(5, 9))


def test_vertices_need_their_shares(case):
    with pytest.raises(ValueError, match="together"):
        evaluate(MeanLearner(), case[0], np.arange(6), np.arange(7, 9), D=case[1])


def test_too_few_frames_to_leave_any_out(case):
    with pytest.raises(ValueError, match="got 3"):
        cross_validate({"mean": MeanLearner()}, case[0].take(np.arange(3)))


def test_rank_correlation_counts_ranks():
    assert rank_correlation(np.array([1.0, 2, 3]), np.array([1.0, 10, 11])) == pytest.approx(1)
    assert rank_correlation(np.array([1.0, 2, 3]), np.array([3.0, 2, 1])) == pytest.approx(-1)
    assert rank_correlation(np.ones(3), np.array([3.0, 2, 1])) == 0


def test_scores_pool_frames_predicted_without_their_block(case):
    training, _, _ = case
    ridge, mean = cross_validate({"ridge": RidgeLearner(), "mean": MeanLearner()}, training, n_folds=4)
    assert ridge.rms < 0.5 * mean.rms
    assert_allclose(np.sqrt(np.mean(mean.errors**2)), mean.rms)
    assert mean.errors.shape == (40,) and mean.fold_rms.shape == (4,)
    assert choose_learner([ridge, mean]).name == "ridge"


def test_noise_falls_back_to_the_mean(rng):
    T = 80
    inputs = Inputs(
        rng.standard_normal((T, 6, 3)), rng.standard_normal((T, 6, 3)), np.zeros((T, 0)), np.zeros(T, int)
    )
    D = rng.standard_normal((T, 10, 3))
    training = Training(inputs, *region_grams(D, np.ones((10, 1))))
    learners = {"mean": MeanLearner(), "ridge": RidgeLearner(), "gp": PlainGaussianProcess()}
    choice = choose_learner(cross_validate(learners, training), "gp")
    assert choice.name == "mean" and "mean's error" in choice.reason


def score(name, rms, folds=None):
    folds = np.full(5, rms) if folds is None else np.array(folds)
    return Score(name, rms, np.full(10, rms), folds, 0.5, 1.0, 0.1)


def test_the_preferred_learner_stays_unless_another_is_clearly_better():
    mean = score("mean", 1.0)
    assert choose_learner([mean, score("regional-gp", 0.5), score("gp", 0.49)]).name == "regional-gp"
    assert choose_learner([mean, score("regional-gp", 0.5), score("gp", 0.4)]).name == "gp"
    assert choose_learner([mean, score("gp", 0.99)]).name == "mean"
    assert choose_learner([mean, score("gp", 0.9, [0.1, 1.2, 1.2, 1.2, 1.2])]).name == "mean"
    assert choose_learner([score("gp", 0.9)]).name == "gp"
    with pytest.raises(ValueError, match="got none"):
        choose_learner([])
