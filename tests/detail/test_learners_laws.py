"""What memory and scales of their own for every joint are good for, on details whose law is known."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic_motion import (
    Motion,
    bent_sheet,
    drag,
    held_out_error,
    spread_out,
    spring,
    static,
    swinging,
    trailing,
    training_of,
    with_idle_joints,
)

from tempose.detail.learners import PlainGaussianProcess, RegionalGaussianProcess
from tempose.detail.learners.memory import frames_remembered, lags_at

TWO_FRAMES = RegionalGaussianProcess(lags=(0,))
MEMORY = RegionalGaussianProcess()


@pytest.mark.parametrize(("tau", "short"), [(1, 0.08), (4, 0.25)])
def test_trailing_needs_memory(tau, short):
    motion = swinging(0)
    D = trailing(motion, tau)
    assert held_out_error(TWO_FRAMES, motion, D) > short
    assert held_out_error(MEMORY, motion, D) < 0.02


def test_the_default_remembers_enough_for_a_spring():
    motion = swinging(1)
    D = spring(motion, 2.0, 0.4)
    assert held_out_error(TWO_FRAMES, motion, D) > 0.3
    assert held_out_error(MEMORY, motion, D) < 0.08


@pytest.mark.parametrize("law", [drag, static])
def test_joints_that_do_not_matter_do_no_harm(law):
    motion = with_idle_joints(swinging(0), 10)
    D = law(motion)
    assert held_out_error(MEMORY, motion, D) < min(
        0.06, 0.3 * held_out_error(PlainGaussianProcess(), motion, D)
    )


def test_a_bent_sheet_is_seen_better_by_joints_than_by_one_scale():
    motion = swinging(1)
    D = bent_sheet(motion)
    assert held_out_error(MEMORY, motion, D) < 0.7 * held_out_error(PlainGaussianProcess(), motion, D)


def test_memory_is_counted_in_seconds():
    # velocity of 0.4 s ago: at 60 Hz that is 24 frames, where 12 reach half as far
    motion = sampled_densely(swinging(0, 220))
    D = spread_out(np.roll(motion.velocity[:, :6], 24, axis=0))
    assert held_out_error(MEMORY, motion, D, 60.0) < 0.3 * held_out_error(MEMORY, motion, D, 30.0)
    assert frames_remembered(MEMORY.fit(training_of(motion, D, 60.0))) == 24


@pytest.mark.parametrize(
    ("fps", "lags"), [(30, (0, 2, 4, 6, 9, 12)), (120, (0, 8, 16, 24, 36, 48)), (5, (0, 1, 2)), (0.1, (0,))]
)
def test_lags_fall_on_the_nearest_frames(fps, lags):
    assert lags_at((0, 2, 4, 6, 9, 12), fps) == lags


def sampled_densely(motion: Motion) -> Motion:
    """Return the motion with a frame between every two."""
    T = len(motion.angles)
    times, moments = np.arange(T), np.arange(2 * T - 1) / 2
    tables = [
        np.stack([np.interp(moments, times, c) for c in part.reshape(T, -1).T], axis=1)
        for part in (motion.angles, motion.swings)
    ]
    return Motion(tables[0].reshape(-1, *motion.angles.shape[1:]), tables[1])
