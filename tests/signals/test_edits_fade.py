"""What is played where the curve was moved: g, and what the path knows beyond it."""

from __future__ import annotations

import numpy as np
from edit_clips import signals_of
from model_clips import swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals import Signals
from tempose.signals.edits import cut, move_control
from tempose.signals.signals import FADE


def rough() -> Signals:
    """So few sites that g is far from the path."""
    return signals_of(swinging(30), k=32, l=6)


def test_unedited_is_the_path_bit_for_bit() -> None:
    signals = rough()
    t = np.linspace(0, signals.duration, 77)
    assert_array_equal(signals.coordinates(t), signals.path(signals.ticks(t)))


def test_a_small_step_adds_the_difference_of_g_and_a_large_one_shows_g() -> None:
    signals = rough()
    t = signals.times[10]
    step = signals.pose_step
    for size, share in ((0.5 * FADE[0], 1.0), (1.5 * FADE[1] / 0.6, 0.0)):
        moved = move_control(signals, 11, [size * step, 0.0])
        f, before = moved.time(moved.ticks(t)), signals.time(signals.ticks(t))
        far = np.linalg.norm(f - before) / step
        assert far < FADE[0] if share else far > FADE[1]
        x = signals.pose(f) + share * (signals.path(signals.ticks(t)) - signals.pose(before))
        assert_allclose(moved.coordinates(t), x, atol=1e-12)


def test_there_is_no_jump_as_a_control_moves_away() -> None:
    signals = rough()
    sizes = np.linspace(0, 8, 400) * signals.pose_step
    x = np.array([move_control(signals, 11, [s, 0.3 * s]).coordinates(signals.times[10]) for s in sizes])
    steps = np.linalg.norm(np.diff(x, axis=0), axis=1)
    assert steps.max() < 12 * np.median(steps)


def test_the_pose_step_is_the_median_way_of_a_frame() -> None:
    signals = rough()
    P = signals.time.before_edits(np.arange(30.0))
    assert_allclose(signals.pose_step, np.median(np.linalg.norm(np.diff(P, axis=0), axis=1)))


def test_one_time_and_many_agree() -> None:
    moved = move_control(rough(), 11, [2.0, 1.0])
    t = np.linspace(0, moved.duration, 40)
    assert_allclose(np.array([moved.coordinates(s) for s in t]), moved.coordinates(t), atol=1e-13)
    assert moved.coordinates(t.reshape(4, 10)).shape == (4, 10, moved.shape.components.shape[0])


def test_cuts_elsewhere_do_not_change_what_moved_controls_show() -> None:
    moved = move_control(signals_of(swinging(80, 17.3), k=82, l=10), 60, [0.9, 0.4])
    shorter = cut(moved, 2, 9)
    assert_allclose(shorter.coordinates(shorter.times[48:]), moved.coordinates(moved.times[55:]), atol=1e-10)
