"""The latent model as a learner: units, vertices, several clips, few frames, still frames, many frames."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from synthetic_motion import bent_sheet, swinging, training_of

from tempose.detail.learners import LEARNERS, LatentLearner
from tempose.detail.saving.tree import from_arrays, to_arrays
from tempose.detail.training import Inputs

BOTH = [LatentLearner(dim=4, iterations=20), replace(LatentLearner.paper(), iterations=20)]
named = pytest.mark.parametrize("learner", BOTH, ids=lambda learner: learner.name)


@pytest.fixture(scope="module")
def training():
    motion = swinging(3, 60)
    return training_of(motion, bent_sheet(motion))


def test_both_settings_are_learners_by_name():
    assert LEARNERS["gplvm"]().name == "gplvm" and LEARNERS["gplvm-paper"]().name == "gplvm-paper"
    paper = LatentLearner.paper()
    assert (paper.dim, paper.iterations, paper.balanced, paper.expected) == (4, 100, False, False)


@named
@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_units_of_residuals_scale_the_variance_and_nothing_else(learner, training, unit):
    scaled = replace(training, grams=unit**2 * training.grams)
    one, other = (learner.fit(t).mix(training.inputs) for t in (training, scaled))
    assert_allclose(other.weights, one.weights, atol=2e-3)
    assert_allclose(other.variance, unit**2 * one.variance, rtol=2e-2)


@named
def test_frames_of_the_training_are_nearly_met(learner, training):
    mixture = learner.fit(training).mix(training.inputs)
    centred = training.centred_gram
    lines = mixture.weights[0] - np.eye(60)
    assert np.trace(lines @ centred @ lines.T) < 0.05 * np.trace(centred)


@named
def test_learning_twice_gives_the_same(learner, training):
    one, two = (learner.fit(training).mix(training.inputs) for _ in range(2))
    assert_allclose(one.weights, two.weights, rtol=0, atol=0)


@named
def test_a_file_keeps_all_of_it(learner, training):
    predictor = learner.fit(training)
    arrays = {}
    again = from_arrays(to_arrays(predictor, "predictor", arrays), arrays)
    one, two = predictor.mix(training.inputs), again.mix(training.inputs)
    assert_allclose(two.weights, one.weights, atol=1e-12)
    assert_allclose(two.variance, one.variance, rtol=1e-12)
    assert again.warnings == predictor.warnings


@named
def test_one_frame_asked_alone_gets_the_answer_of_the_batch(learner, training):
    predictor = learner.fit(training)
    batch, one = predictor.mix(training.inputs), predictor.mix(training.inputs.take(np.array([17])))
    assert_allclose(one.weights[0, 0], batch.weights[0, 17], atol=1e-9)
    assert_allclose(one.variance[0], batch.variance[17], rtol=1e-5)


@named
def test_fewer_frames_than_latent_dimensions_lower_them_and_say_so(training, learner):
    few = replace(learner, dim=16).fit(training.take(np.arange(10)))
    assert few.latent.shape == (10, 9)
    assert any("10 frames hold no 16 latent dimensions, 9 are used" in w for w in few.warnings)
    assert not learner.fit(training).warnings


@named
@pytest.mark.parametrize("T", [1, 2])
def test_next_to_no_frames_predict_the_mean(training, learner, T):
    predictor = learner.fit(training.take(np.arange(T)))
    mixture = predictor.mix(training.inputs)
    assert mixture.weights.shape == (1, 60, T) and not mixture.weights.any()
    assert any("too few to learn from" in w for w in predictor.warnings)
    with pytest.raises(ValueError, match="no latent space"):
        predictor.plane()


@named
@pytest.mark.parametrize("still", ["poses", "residuals"])
def test_constant_frames_predict_the_mean(training, learner, still):
    if still == "poses":
        inputs = replace(
            training.inputs, angles=0 * training.inputs.angles, velocity=0 * training.inputs.angles
        )
        case = replace(training, inputs=inputs)
    else:
        case = replace(training, grams=np.full_like(training.grams, 0.37))
    assert not learner.fit(case).mix(training.inputs).weights.any()


def test_no_latent_dimension_is_refused(training):
    with pytest.raises(ValueError, match="dim must be 1 or more, got 0"):
        LatentLearner(dim=0).fit(training)


@named
def test_many_frames_are_thinned_evenly_and_said(training, learner):
    predictor = replace(learner, judged=20).fit(training)
    assert predictor.latent.shape[0] == 20 and "20 of 60 frames" in predictor.warnings[-1]
    weights = predictor.mix(training.inputs).weights[0]
    assert weights.shape == (60, 60)
    assert np.count_nonzero(np.abs(weights).sum(axis=0)) == 20


@named
def test_two_clips_do_not_depend_on_which_comes_first(training, learner):
    halves = np.r_[30:60, :30]
    inputs = training.inputs
    first = replace(training, inputs=chained(inputs, np.arange(60)))
    second = replace(training, inputs=chained(inputs, halves), grams=training.grams[:, halves][:, :, halves])
    one, two = (learner.fit(t).mix(inputs) for t in (first, second))
    # the same minimum is reached by other rounding
    assert_allclose(
        two.weights[0][:, np.argsort(halves)] @ training.centred_gram,
        one.weights[0] @ training.centred_gram,
        atol=0.05 * np.trace(training.centred_gram) / 60,
    )


def chained(inputs: Inputs, order: np.ndarray) -> Inputs:
    return Inputs(
        inputs.angles[order],
        inputs.velocity[order],
        inputs.extra[order],
        np.repeat([0, 1], 30),
        inputs.joints,
    )
