"""New frames between two moments join what is there smoothly and leave it as it was."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import bending, played, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from model_clips import swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals import Signals
from tempose.signals.edits import blend, insert_curve, move_control, retime, set_speed
from tempose.signals.placement import placement_at

BASE = signals_of(swinging(40), k=42, l=14)
WALK = signals_of(bending(30, drift=1.5), placement=True)


def drawn(signals: Signals, *frames: int) -> np.ndarray:
    return signals.time(np.array(frames, dtype=float)) + 0.2 * signals.pose_step


@settings(max_examples=15)
@given(st.floats(0, 39), st.integers(1, 4), st.floats(2, 20))
def test_an_inserted_loop_leaves_the_rest_as_it_was(at: float, count: int, frames: float) -> None:
    longer = insert_curve(BASE, at, drawn(BASE, *range(3, 3 + 5 * count, 5)), frames)
    assert_allclose(longer.duration, BASE.duration + frames / BASE.fps)
    s = np.linspace(0, at / BASE.fps, 50)
    assert_allclose(longer.coordinates(s), BASE.coordinates(s), atol=1e-9)
    s = np.linspace(at / BASE.fps, BASE.duration, 50)
    assert_allclose(longer.coordinates(s + frames / BASE.fps), BASE.coordinates(s), atol=1e-9)


def test_frames_well_before_an_inserted_loop_are_bit_identical() -> None:
    longer = insert_curve(BASE, 20, drawn(BASE, 5), 8)
    assert_array_equal(played(longer)[:17], played(BASE)[:17])


def test_the_loop_runs_through_the_drawn_points() -> None:
    points = drawn(BASE, 5, 30, 12)
    longer = insert_curve(BASE, 20, points, 24)
    path = longer.time(np.linspace(20, 44, 20001))
    gaps = np.linalg.norm(path[:, None] - points, axis=2)
    assert gaps.min(axis=0).max() < 1e-2 * BASE.pose_step
    assert (np.diff(gaps.argmin(axis=0)) > 0).all()


@pytest.mark.parametrize("at", [20, 13.4])
def test_curvature_has_no_jump_where_a_loop_begins_and_ends(at: float) -> None:
    longer = insert_curve(BASE, at, drawn(BASE, 5, 30), 10)
    for spline, u in ((longer.path, at), (longer.path, at + 10)):
        for order in range(3):
            before, after = (spline(u + e, derivative=order) for e in (-1e-8, 1e-8))
            assert_allclose(before, after, atol=1e-6 * np.abs(before).max())
    for u in longer.time.pace(np.array([at, at + 10.0])):
        for order in range(3):
            before, after = (longer.time.curve(u + e, derivative=order) for e in (-1e-8, 1e-8))
            assert_allclose(before, after, atol=1e-5 * np.abs(before).max())


def test_the_drawn_pose_is_shown() -> None:
    """Half way the path no longer knows the frame where the loop began: the pose is that of g."""
    at = BASE.time(np.array(33.0))
    longer = insert_curve(BASE, 10, at[None], 16)
    t = np.linspace(10, 26, 4001)
    nearest = t[np.linalg.norm(longer.time(t) - at, axis=1).argmin()]
    step = np.linalg.norm(np.diff(BASE.coordinates(BASE.times), axis=0), axis=1).mean()
    assert np.linalg.norm(longer.coordinates_at(nearest) - BASE.pose(at)) < 0.05 * step


@pytest.mark.parametrize(("a", "b"), [(10, 25), (25, 10), (30, 39), (12, 0)])
def test_a_blend_goes_on_from_the_other_place(a: int, b: int) -> None:
    edited = blend(BASE, a, b, 6)
    assert edited.n_frames == a + 6 + (40 - b)
    assert_allclose(played(edited)[: a + 1], played(BASE)[: a + 1], atol=1e-9)
    assert_allclose(played(edited)[a + 6 :], played(BASE)[b:], atol=1e-9)
    steps = np.linalg.norm(np.diff(edited.coordinates(edited.times), axis=0), axis=1)
    gap = np.linalg.norm(BASE.coordinates(a / BASE.fps) - BASE.coordinates(b / BASE.fps))
    assert steps[a : a + 6].max() < gap + np.median(steps)


def test_retimed_and_edited_clips_take_loops_too() -> None:
    slow = set_speed(retime(BASE, keys=[[0, 0], [20, 12], [50, 39]]), 5, 15, 0.5)
    signals = move_control(slow, 12, [0.3, 0.2])
    at = 17.3
    longer = insert_curve(signals, at, drawn(BASE, 30), 9)
    s = np.linspace(0, at / BASE.fps, 60)
    assert_allclose(longer.coordinates(s), signals.coordinates(s), atol=1e-7)
    s = np.linspace(at / BASE.fps, signals.duration, 60)
    assert_allclose(longer.coordinates(s + 9 / BASE.fps), signals.coordinates(s), atol=1e-7)


def test_a_loop_where_the_clip_stands_still_is_played() -> None:
    held = retime(BASE, keys=[[0, 0], [10, 10], [20, 10], [30, 20]])
    longer = insert_curve(held, 15, drawn(BASE, 30), 12)
    x = longer.coordinates(longer.times[15:28])
    way = np.linalg.norm(np.diff(BASE.path.controls, axis=0), axis=1)
    assert np.linalg.norm(x - x[0], axis=1).max() > way.max()


def test_a_walker_walks_on_through_a_loop() -> None:
    longer = insert_curve(WALK, 15, drawn(WALK, 3), 6)
    x = placement_at(longer.placement, np.arange(36.0))[:, 4]
    steps = np.diff(x)
    assert steps[15:21].min() > 0.3 * np.median(steps)
    assert steps[15:21].max() < 2 * np.median(steps)
    assert_allclose(played(longer)[:14], played(WALK)[:14], atol=1e-6)


@pytest.mark.parametrize("frames", [0, 0.5, -3, np.inf, np.nan, True])
def test_a_length_that_is_none_is_refused(frames: float) -> None:
    with pytest.raises(ValueError, match="frames must be 1 or more"):
        blend(BASE, 3, 9, frames)


@pytest.mark.parametrize("points", [[], [[1, 2, 3]], [1, 2], [[np.nan, 0]]])
def test_points_that_are_none_are_refused(points: object) -> None:
    with pytest.raises(ValueError, match="points must"):
        insert_curve(BASE, 3, points, 5)  # type: ignore[arg-type]
