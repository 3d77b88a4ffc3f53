"""A moved control changes the frames under its support, and not one bit of any other."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from edit_clips import bending, played, reach, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from model_clips import swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import load_clip
from tempose.samples import sample_clip
from tempose.signals import Signals
from tempose.signals.edits import insert_control, loop, move_control, place_control, retime, set_speed


@cache
def base(kind: str) -> Signals:
    if kind == "few controls":
        return signals_of(swinging(30), k=14, l=12)
    signals = signals_of(bending(20), kind.split()[0])
    if kind.endswith("retimed"):
        return set_speed(retime(signals, keys=[[0, 0], [10, 6], [24, 19]]), 4, 12, 0.5)
    if kind.endswith("looped"):
        return loop(signals, 2, 10, 2)
    return signals


KINDS = ("vertex", "gradient", "few controls", "vertex retimed", "gradient retimed", "vertex looped")


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=12)
@given(where=st.floats(0, 1), x=st.floats(-2, 2), y=st.floats(-2, 2))
def test_frames_outside_the_support_are_bit_identical(kind: str, where: float, x: float, y: float) -> None:
    signals = base(kind)
    control = round(where * (len(signals.time.curve.controls) - 1))
    by = np.array([x, y]) * signals.pose_step
    moved, before = played(move_control(signals, control, by)), played(signals)
    touched = reach(signals, control)
    assert not touched.all()
    assert_array_equal(moved[~touched], before[~touched])
    if np.abs(by).max() > 1e-6 * signals.pose_step and touched.any():
        assert (moved[touched] != before[touched]).any()


def test_a_moved_control_moves_the_curve_by_its_basis_function() -> None:
    signals = base("few controls")
    moved = move_control(signals, 5, [0.3, -0.1])
    curve = signals.time.curve
    unit = np.zeros((len(curve.controls), 1))
    unit[5] = 1
    t = np.linspace(0, signals.duration, 50)
    u = signals.time.pace(signals.ticks(t))
    share = type(curve)(curve.knots, unit)(u)
    assert_allclose(moved.time.curve(u) - curve(u), share * [0.3, -0.1], atol=1e-13)
    assert moved.time.unedited is signals.time.unedited


def test_moving_there_and_back_is_no_edit() -> None:
    signals = base("vertex")
    there = move_control(signals, 7, [0.5, 0.25])
    back = place_control(there, 7, signals.time.curve.controls[7])
    assert_array_equal(played(back), played(signals))


@pytest.mark.parametrize("kind", ["vertex", "gradient", "few controls", "vertex looped"])
@pytest.mark.parametrize("at", [0, 0.4, 7, 11.5, 19])
def test_a_control_more_changes_nothing(kind: str, at: float) -> None:
    signals = move_control(base(kind), 6, [0.2, 0.1])
    more = insert_control(signals, at)
    assert len(more.time.curve.controls) == len(signals.time.curve.controls) + 1
    t = np.linspace(0, signals.duration, 300)
    assert_allclose(
        more.coordinates(t), signals.coordinates(t), atol=1e-12 * np.abs(signals.path.controls).max()
    )


def test_a_control_more_gives_a_finer_hold_that_stays_smooth() -> None:
    signals = base("few controls")
    more = insert_control(insert_control(signals, 12), 12)
    knots = more.time.curve.knots
    assert np.diff(knots[3:-3]).min() > 0
    widest = max(reach(signals, c).sum() for c in range(4, 9))
    finest = min(reach(more, c).sum() for c in range(4, 11))
    assert finest < widest


@pytest.mark.parametrize("control", [-1, 16, 40, 1.5, True, "3"])
def test_a_control_that_does_not_exist_is_refused(control: object) -> None:
    signals = signals_of(swinging(30), k=16, l=12)
    with pytest.raises(ValueError, match=r"control must be from 0 to 15, got"):
        move_control(signals, control, [0, 0])  # type: ignore[arg-type]


@pytest.mark.parametrize("by", [[1], [1, 2, 3], [np.nan, 0], "ab"])
def test_a_step_that_is_no_pair_is_refused(by: object) -> None:
    with pytest.raises(ValueError, match="by must"):
        move_control(base("vertex"), 3, by)  # type: ignore[arg-type]


@pytest.mark.parametrize("at", [-1, 20, np.nan, True])
def test_a_frame_that_does_not_exist_is_refused(at: float) -> None:
    with pytest.raises(ValueError, match="at must be a frame from 0 to 19"):
        insert_control(base("vertex"), at)


@pytest.mark.slow
@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_a_walking_sample_changes_only_under_the_support(space: str) -> None:
    signals = signals_of(sample_clip("human", "walk", triangles=4000, fps=12), space, k=14, l=14)
    for edited in (signals, set_speed(signals, 3, 9, 0.5), loop(signals, 2, 10, 2)):
        moved, before = played(move_control(edited, 7, [0.5, 0.3])), played(edited)
        touched = reach(edited, 7)
        assert_array_equal(moved[~touched], before[~touched])
        assert touched.any() and not touched.all() and (moved[touched] != before[touched]).any()


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_horse_gallop_changes_only_under_the_support(space: str, data_folder) -> None:
    from tempose.clips import MeshClip

    gallop = load_clip(data_folder("horse-gallop"), fps=24)
    signals = signals_of(MeshClip(gallop.vertices[:24], gallop.mesh, 24), space, k=16)
    for edited in (signals, set_speed(signals, 3, 9, 0.5), loop(signals, 2, 14, 2)):
        moved, before = played(move_control(edited, 9, [2.0, 1.0])), played(edited)
        touched = reach(edited, 9)
        assert_array_equal(moved[~touched], before[~touched])
        assert (moved[touched] != before[touched]).any(axis=(1, 2)).all()
