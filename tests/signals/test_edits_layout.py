"""Frames given their places get them exactly, and go on showing what they did."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import bending, played, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from model_clips import CORNERS, clip_of, swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals import Signals
from tempose.signals.edits import (
    insert_curve,
    move_control,
    pin_frames,
    repair_transitions,
    set_speed,
)
from tempose.signals.pose.transitions import find_bad_transitions

BASE = signals_of(swinging(30), layout="mds")


def place(signals: Signals, frame: float) -> np.ndarray:
    return signals.time(signals.ticks(np.array(frame / signals.fps)))


@settings(max_examples=8)
@given(st.integers(0, 29), st.floats(-1, 1), st.floats(-1, 1))
def test_a_pinned_frame_lies_where_it_was_pinned(frame: int, x: float, y: float) -> None:
    at = np.array([x, y])
    pinned = pin_frames(BASE, {frame: at})
    assert_allclose(place(pinned, frame), at, atol=1e-12)
    assert_array_equal(played(pinned), played(BASE))


@pytest.mark.parametrize("k", [10, 32])
def test_several_pins_hold_together_with_any_number_of_controls(k: int) -> None:
    signals = signals_of(swinging(30), k=k, l=20)
    wanted = {4: [0.3, 0.1], 17: [-0.4, 0.2], 25: [0.0, -0.5]}
    pinned = pin_frames(signals, wanted)
    for frame, at in wanted.items():
        assert_allclose(place(pinned, frame), at, atol=1e-9)
    assert len(pinned.time.curve.controls) == k


def test_the_others_are_laid_out_round_a_pinned_frame() -> None:
    """Distances in the plane stay those of the poses as well as they can."""
    pinned = pin_frames(BASE, {12: place(BASE, 12) + 0.3})
    moved = pinned.time(np.arange(30.0)) - BASE.time(np.arange(30.0))
    assert_allclose(moved, 0.3, atol=0.05)


def test_frames_of_edited_and_retimed_clips_are_kept() -> None:
    edited = move_control(set_speed(BASE, 5, 15, 0.5), 12, [0.1, 0.05])
    pinned = pin_frames(edited, {14: [0.2, 0.2]})
    assert_allclose(place(pinned, 14), [0.2, 0.2], atol=1e-9)
    step = np.linalg.norm(np.diff(edited.coordinates(edited.times), axis=0), axis=1).mean()
    off = np.linalg.norm(pinned.coordinates(edited.times) - edited.coordinates(edited.times), axis=1)
    assert off.max() < 0.02 * step


def test_a_pinned_clip_can_still_be_edited_locally() -> None:
    pinned = pin_frames(BASE, {14: [0.2, 0.2]})
    moved = move_control(pinned, 16, [0.1, 0.0])
    same = (played(moved) == played(pinned)).all(axis=(1, 2))
    assert same[:13].all() and same[18:].all() and not same.all()


def test_a_pin_beyond_the_clip_is_refused() -> None:
    with pytest.raises(ValueError, match="frame must be a frame from 0 to 29, got 30"):
        pin_frames(BASE, {30: [0, 0]})
    with pytest.raises(ValueError, match="at must"):
        pin_frames(BASE, {3: [0, 0, 0]})


def bad(signals: Signals) -> int:
    ticks = np.arange(signals.time.pace.domain[1] + 1)
    return int(find_bad_transitions(signals.pose, signals.time, signals.path(ticks)).bad.sum())


def knotted() -> Signals:
    """Motion of many dimensions, squeezed into the plane by plain scaling."""
    rng = np.random.default_rng(4)
    w = np.arange(24)[:, None] * np.array([0.35, 0.53, 0.81, 1.1])
    X = np.concatenate([np.sin(w), np.cos(w)], axis=1) @ rng.normal(size=(8, 12))
    return signals_of(clip_of(CORNERS + 0.1 * X.reshape(24, 4, 3)), layout="mds")


@pytest.mark.slow
def test_repair_leaves_no_bad_transition_and_every_frame() -> None:
    signals = knotted()
    repaired = repair_transitions(signals)
    assert bad(signals) > 5
    assert bad(repaired) == 0
    assert_array_equal(played(repaired), played(signals))


def test_a_clip_without_bad_transitions_is_left_alone() -> None:
    signals = signals_of(bending(30, cycles=0.8))
    assert bad(signals) == 0
    assert repair_transitions(signals) is signals


def test_layouts_of_clips_with_drawn_loops() -> None:
    longer = insert_curve(BASE, 10, [place(BASE, 20)], 7.5)
    pinned = pin_frames(longer, {30: [0.1, 0.1]})
    assert_allclose(place(pinned, 30), [0.1, 0.1], atol=1e-9)
    assert_allclose(played(pinned), played(longer), atol=1e-6)
