"""Detail with known laws: what each learner finds in two frames, and where each of them fails.

Errors are parts of the rms of the detail on the last 30 % of the frames: 1 is what predicting nothing has.
"""

from __future__ import annotations

import numpy as np
import pytest
from synthetic_motion import (
    Motion,
    bent_sheet,
    drag,
    free,
    held_out_error,
    smooth,
    spread_out,
    spring,
    static,
    swinging,
    trailing,
    training_of,
    with_idle_joints,
)

from tempose.detail.evaluation import choose_learner, cross_validate
from tempose.detail.learners import (
    LEARNERS,
    LatentLearner,
    MeanLearner,
    PlainGaussianProcess,
    RegionalGaussianProcess,
)

MEMORY = RegionalGaussianProcess(lags=(0, 2, 4, 6, 9, 12))
FINDS = [PlainGaussianProcess(), RegionalGaussianProcess(), LatentLearner(dim=8, iterations=40)]
finders = pytest.mark.parametrize("learner", FINDS, ids=lambda learner: learner.name)


def without_velocity(motion: Motion) -> Motion:
    """Every frame is given as if the body stood still."""

    class Still(Motion):
        @property
        def velocity(self) -> np.ndarray:
            return np.zeros_like(self.angles)

    return Still(motion.angles, motion.swings)


@finders
@pytest.mark.parametrize("law", [static, drag], ids=["static", "drag"])
def test_two_frames_tell_pose_and_velocity(learner, law):
    motion = swinging(0, 200)
    assert held_out_error(learner, motion, law(motion)) < 0.15


def test_a_pose_alone_does_not_tell_its_drag():
    motion = swinging(0, 200)
    assert held_out_error(RegionalGaussianProcess(lags=(0,)), without_velocity(motion), drag(motion)) > 0.7


@finders
def test_trailing_by_a_frame_is_told_by_two_frames(learner):
    motion = swinging(1, 200)
    assert held_out_error(learner, motion, trailing(motion, 1.0)) < 0.25


def test_a_spring_needs_a_memory():
    motion = swinging(1)
    D = spring(motion, 2.0, 0.4)
    assert held_out_error(PlainGaussianProcess(), motion, D) > 0.3
    assert held_out_error(MEMORY, motion, D) < 0.08


def test_a_spring_that_rings_is_told_by_nobody():
    """Its memory is longer than any that is looked at."""
    motion = swinging(1)
    D = spring(motion, 1.5, 0.1)
    assert held_out_error(PlainGaussianProcess(), motion, D) > 0.5
    assert held_out_error(MEMORY, motion, D) > 0.2


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_the_latent_model_wins_where_motion_is_a_bent_sheet(seed):
    motion = swinging(seed)
    D = bent_sheet(motion)
    plain = held_out_error(PlainGaussianProcess(), motion, D)
    assert held_out_error(LatentLearner(), motion, D) < 0.8 * plain


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_idle_joints_break_the_paper_and_not_the_scaled_model(seed):
    """Real edits look like this: arms are moved, the skirt does not care."""
    motion = with_idle_joints(swinging(seed))
    D = drag(motion)
    assert held_out_error(LatentLearner.paper(), motion, D) > 0.8
    assert held_out_error(LatentLearner(), motion, D) < 0.05
    assert held_out_error(RegionalGaussianProcess(), motion, D) < 0.05


def test_detail_that_motion_does_not_tell_falls_back_to_the_mean():
    """Free motion, detail with a life of its own: learners lose to a constant and are not taken."""
    motion = free(0, 120)
    D = spread_out(smooth(np.random.default_rng(9), 120, 6, 6.0)) + 0.5
    learners = {name: LEARNERS[name]() for name in ("mean", "ridge", "gp")}
    learners["gplvm"] = LatentLearner(dim=8, iterations=20)
    scores = cross_validate(learners, training_of(motion, D), n_folds=3)
    base = scores[0].rms
    assert min(score.rms for score in scores[1:]) > 0.97 * base
    assert choose_learner(scores).name == MeanLearner().name
