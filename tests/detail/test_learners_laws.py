"""What memory and scales of their own for every joint are good for, on details whose law is known."""

from __future__ import annotations

import pytest
from synthetic_motion import (
    bent_sheet,
    drag,
    held_out_error,
    spring,
    static,
    swinging,
    trailing,
    with_idle_joints,
)

from tempose.detail.learners import PlainGaussianProcess, RegionalGaussianProcess

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
