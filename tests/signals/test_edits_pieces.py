"""Cuts, loops, pastes and reversals: what is put in and taken out again leaves the clip as it was."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import played, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from model_clips import CORNERS, clip_of, swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals import Signals
from tempose.signals.edits import apply_edits, cut, keep, loop, paste, reverse, set_speed

LONG = signals_of(swinging(80, 17.3), k=50, l=40)
SEAM = 24
"""Frames on each side of a seam that its offsets may reach: 8 half-lives."""

part = st.tuples(st.integers(2, 60), st.integers(3, 15)).map(lambda p: (p[0], p[0] + p[1]))


def cyclic() -> Signals:
    """Four rounds of eleven frames, to rounding."""
    w = 2 * np.pi * np.arange(45)[:, None, None] / 11
    a = 0.2 * np.random.default_rng(3).normal(size=(3, 4, 3))
    return signals_of(clip_of(CORNERS + a[0] * np.sin(w) + a[1] * np.cos(w) + 0.3 * a[2] * np.sin(2 * w)))


@settings(max_examples=10)
@given(part, st.integers(2, 4))
def test_loop_then_cut_is_no_edit_away_from_the_seam(span: tuple[int, int], times: int) -> None:
    a, b = span
    looped = loop(LONG, a, b, times)
    assert looped.n_frames == 80 + (times - 1) * (b - a)
    back = cut(looped, b, b + (times - 1) * (b - a))
    assert back.n_frames == 80
    q = np.arange(80)
    far = np.abs(q - b) > SEAM + (b - a)
    assert_array_equal(played(back)[far & (q < b)], played(LONG)[far & (q < b)])
    assert_allclose(played(back)[far], played(LONG)[far], atol=1e-10)


def test_a_loop_of_an_exact_cycle_cut_out_again_is_no_edit() -> None:
    signals = cyclic()
    looped = loop(signals, 11, 22, 3)
    assert_allclose(played(looped)[22:44], played(signals)[11:33], atol=1e-3)
    back = cut(looped, 22, 44)
    assert_allclose(played(back), played(signals), atol=1e-3)


@settings(max_examples=10)
@given(part, st.integers(2, 77))
def test_paste_then_cut_is_no_edit_away_from_the_seam(span: tuple[int, int], at: int) -> None:
    a, b = span
    pasted = paste(LONG, a, b, at)
    assert pasted.n_frames == 80 + b - a
    back = cut(pasted, at, at + b - a)
    far = np.abs(np.arange(80) - at) > SEAM + (b - a)
    assert back.n_frames == 80
    assert_allclose(played(back)[far], played(LONG)[far], atol=1e-10)


def test_a_pasted_part_shows_what_was_copied() -> None:
    pasted = played(paste(LONG, 4, 70, 75))
    assert_allclose(pasted[75 + 30 : 75 + 40], played(LONG)[34:44], atol=1e-3)


@settings(max_examples=10)
@given(part)
def test_reversing_twice_is_no_edit_away_from_the_seams(span: tuple[int, int]) -> None:
    a, b = span
    back = reverse(reverse(LONG, a, b), a, b)
    q = np.arange(80)
    far = (q < a - SEAM - (b - a)) | (q > b + SEAM + (b - a))
    assert_allclose(played(back)[far], played(LONG)[far], atol=1e-10)


def test_a_part_played_backwards() -> None:
    signals = cyclic()
    assert_allclose(played(reverse(signals, 0, 44)), played(signals)[::-1], atol=1e-9)


def test_keeping_all_is_no_edit_and_keeping_a_part_keeps_its_frames() -> None:
    assert_allclose(played(keep(LONG, 0, 79)), played(LONG), atol=1e-12)
    kept = keep(LONG, 20, 50)
    assert kept.n_frames == 31
    assert_allclose(played(kept), played(LONG)[20:51], atol=1e-10)


def test_cutting_an_end_keeps_the_rest() -> None:
    assert_allclose(played(cut(LONG, 0, 30)), played(LONG)[30:], atol=1e-10)
    assert_allclose(played(cut(LONG, 60, 79)), played(LONG)[:61], atol=1e-10)


def test_playing_once_is_no_edit() -> None:
    assert loop(LONG, 3, 9, 1) is LONG


def test_parts_are_counted_in_what_is_played() -> None:
    slow = set_speed(LONG, 0, 79, 0.5)
    assert_allclose(played(keep(slow, 40, 100)), played(slow)[40:101], atol=1e-9)


@pytest.mark.parametrize("edit", [cut, keep, reverse])
def test_parts_that_are_none_are_refused(edit) -> None:
    for a, b, message in (
        (5, 5, "after from"),
        (9, 3, "after from"),
        (0, 80, "to must be a frame from 0 to 79"),
    ):
        with pytest.raises(ValueError, match=message):
            edit(LONG, a, b)


def test_cutting_everything_and_looping_never_are_refused() -> None:
    with pytest.raises(ValueError, match="leaves nothing"):
        cut(LONG, 0, 79)
    for times in (0, -1, 1.5, True):
        with pytest.raises(ValueError, match="times must be 1 or more"):
            loop(LONG, 3, 9, times)  # type: ignore[arg-type]


@pytest.mark.parametrize("times", [2, 3])
def test_a_stride_that_ends_with_the_clip_repeats_frame_by_frame(times: int) -> None:
    """Frame 24 of two strides of 12 frames is the first of a third: none was captured, none is left out."""
    w = 2 * np.pi * np.arange(24)[:, None, None] / 12
    a = 0.2 * np.random.default_rng(3).normal(size=(2, 4, 3))
    signals = signals_of(clip_of(CORNERS + a[0] * np.sin(w) + a[1] * np.cos(w)), k=26, l=12)
    once = played(signals)
    looped = loop(signals, 12, 24, times)
    again = played(looped)
    assert len(again) == 24 + 12 * (times - 1)
    assert_allclose(again[:24], once, atol=1e-9)
    for i in range(1, times):
        assert_allclose(again[24 + 12 * (i - 1) : 24 + 12 * i], once[12:], atol=1e-9)
    steps = np.linalg.norm(np.diff(again, axis=0).reshape(len(again) - 1, -1), axis=1)
    assert steps.max() <= 1.01 * np.linalg.norm(np.diff(once, axis=0).reshape(23, -1), axis=1).max()


def test_a_part_of_a_frame_cannot_be_inserted() -> None:
    entry = {"op": "close_loop", "from": 5, "to": 30, "insert": 2.5}
    with pytest.raises(ValueError, match=r"insert must be a whole number, got 2\.5"):
        apply_edits(LONG, [entry])
    assert apply_edits(LONG, [{**entry, "insert": 2}]).duration * LONG.fps == pytest.approx(28)
