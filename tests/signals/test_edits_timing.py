"""Retiming changes when a moment is played, never what it shows."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import played, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from model_clips import swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals.edits import retime, set_fps, set_speed

BASE = signals_of(swinging(30), k=20, l=16)


@settings(max_examples=25)
@given(st.floats(1, 500))
def test_frame_rate_there_and_back_is_no_edit(fps: float) -> None:
    back = set_fps(set_fps(BASE, fps), BASE.fps)
    assert back.n_frames == 30
    assert_array_equal(played(back), played(BASE))


def test_twice_the_frame_rate_keeps_every_frame() -> None:
    double = set_fps(BASE, 2 * BASE.fps)
    assert double.n_frames == 2 * 29 + 1
    assert_allclose(played(double)[::2], played(BASE), atol=1e-14)


def test_times_are_read_as_given() -> None:
    times = np.array([0.0, 0.1, 0.1, 0.35, 1.0, BASE.duration])
    edited = retime(BASE, times=times)
    assert edited.n_frames == len(times)
    assert_allclose(edited.coordinates(edited.times), BASE.coordinates(times), atol=1e-12)


def test_the_times_of_the_frames_are_no_edit() -> None:
    edited = retime(BASE, times=BASE.times)
    t = np.linspace(0, BASE.duration, 200)
    assert_allclose(edited.coordinates(t), BASE.coordinates(t), atol=1e-12)


@settings(max_examples=25)
@given(st.lists(st.floats(0.2, 5), min_size=2, max_size=8))
def test_a_retiming_and_its_inverse_meet_at_their_keys(steps: list[float]) -> None:
    out = np.concatenate([[0], np.cumsum(steps)])
    inside = np.linspace(0, 29, len(out)) ** 1.2 / 29**0.2
    there = retime(BASE, keys=np.stack([out, inside], axis=1))
    back = retime(there, keys=np.stack([inside, out], axis=1))
    t = inside / BASE.fps
    assert_allclose(back.ticks(t), BASE.ticks(t), atol=1e-9)


def test_an_even_retiming_and_its_inverse_are_no_edit() -> None:
    back = retime(retime(BASE, keys=[[0, 0], [58, 29]]), keys=[[0, 0], [29, 58]])
    assert_allclose(back.ticks(BASE.times), BASE.ticks(BASE.times), atol=1e-12)


@pytest.mark.parametrize("factor", [0.25, 0.5, 3.0])
def test_speed_changes_the_part_only(factor: float) -> None:
    edited = set_speed(BASE, 8, 20, factor)
    ticks = edited.ticks(edited.times)
    assert_array_equal(ticks[ticks <= 8], np.arange(9.0))
    t = np.linspace(0, edited.duration, 4000)
    speed = np.gradient(edited.ticks(t), t) / BASE.rate
    x = edited.ticks(t)
    assert_allclose(speed[(x < 7.9) | (x > 20.1)], 1.0, atol=1e-6)
    assert_allclose(speed[(x > 11.5) & (x < 16.5)], factor, rtol=1e-6)
    assert np.abs(np.diff(speed)).max() < 0.02 * max(factor, 1)
    longer = edited.duration - BASE.duration
    assert_allclose(edited.ticks(BASE.times[20:] + longer), np.arange(20.0, 30.0), atol=1e-9)


def test_speed_of_the_whole_clip_is_even() -> None:
    edited = set_speed(BASE, 0, 29, 2)
    assert_allclose(edited.duration, BASE.duration / 2)
    assert_allclose(edited.ticks(edited.times), 2 * np.arange(15.0), atol=1e-12)


@pytest.mark.parametrize("ease", [0, 1, 100])
def test_ease_never_takes_more_than_half_the_part(ease: float) -> None:
    edited = set_speed(BASE, 8, 20, 0.5, ease=ease)
    middle = edited.duration / 2
    around = np.array([middle - 1e-4, middle + 1e-4])
    assert_allclose(np.diff(edited.ticks(around)) / np.diff(around) / BASE.rate, 0.5, rtol=1e-6)


def test_edits_of_edits_compose() -> None:
    first = set_speed(BASE, 5, 15, 0.5)
    second = retime(first, keys=[[0, 0], [20, 30]])
    t = np.linspace(0, second.duration, 50)
    assert_allclose(second.coordinates(t), first.coordinates(1.5 * t), atol=1e-11)


@pytest.mark.parametrize(
    ("times", "keys", "message"),
    [
        (None, None, "either times or keys"),
        ([0, 1], [[0, 0], [1, 1]], "either times or keys"),
        ([0.5], None, "2 or more entries, got 1"),
        ([0, 0.5, 0.4], None, "must not run backwards, entry 2 does"),
        ([0, 5.0], None, r"from 0 to 1.20833, entry 1 is 5"),
        ([-0.5, 1.0], None, "entry 0 is -0.5"),
        (None, [[1, 0], [5, 5]], "begin with frame 0"),
        (None, [[0, 0], [0, 5]], "ever later frames"),
        (None, [[0, 0], [5, 30]], r"from 0 to 29, entry 1 is 30"),
        (None, [[0, 0, 1]], r"shape \(K, 2\)"),
        ([0, np.inf], None, "finite"),
    ],
)
def test_a_retiming_that_cannot_be_is_refused(times: object, keys: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        retime(BASE, times=times, keys=keys)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [0, -3, np.nan, np.inf])
def test_rates_and_factors_that_are_not_positive_are_refused(value: float) -> None:
    with pytest.raises(ValueError, match="value must be a positive"):
        set_fps(BASE, value)
    with pytest.raises(ValueError, match="factor must be positive"):
        set_speed(BASE, 3, 9, value)


def test_a_part_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="to must be a frame after from = 9, got 9"):
        set_speed(BASE, 9, 9, 2)
    with pytest.raises(ValueError, match="to must be a frame from 0 to 29, got 30"):
        set_speed(BASE, 9, 30, 2)
