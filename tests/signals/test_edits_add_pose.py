"""A sculpted pose is shown where it was put; frames stay what they were."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import bending, played, signals_of, tube
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals import Signals
from tempose.signals.edits import move_control
from tempose.signals.edits.add_pose import add_pose


def shown_at(signals: Signals, at: np.ndarray) -> np.ndarray:
    return signals.shape.vertices(signals.pose(np.asarray(at)))


@pytest.mark.parametrize("space", ["vertex", "gradient"])
@settings(max_examples=8)
@given(x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 0.5), bend=st.floats(-1, 1))
def test_the_pose_is_shown_at_its_place_and_frames_are_bit_identical(
    space: str, x: float, y: float, bend: float
) -> None:
    signals = CLIPS[space]
    pose = tube(bend=(bend, -0.7))
    edited = add_pose(signals, pose, [x, y])
    V = shown_at(edited, np.array([x, y]))
    V = V - (V - pose.vertices).mean(axis=0) if space == "gradient" else V
    assert_allclose(V, pose.vertices, atol=1e-6)
    assert_array_equal(played(edited), played(signals))


CLIPS = {space: signals_of(bending(16), space) for space in ("vertex", "gradient")}


def test_sites_keep_their_poses() -> None:
    signals = CLIPS["vertex"]
    edited = add_pose(signals, tube(bend=(0.3, -1.2)), [0.3, 0.3])
    assert_allclose(shown_at(edited, signals.pose.sites), shown_at(signals, signals.pose.sites), atol=1e-9)
    assert len(edited.pose.sites) == len(signals.pose.sites) + 1


def test_a_curve_moved_there_shows_the_pose() -> None:
    signals = CLIPS["vertex"]
    pose, at = tube(bend=(0.3, -1.2)), np.array([0.4, 0.35])
    edited = add_pose(signals, pose, at)
    curve = edited.time.curve
    u = edited.time.pace(np.array(8.0))
    share = type(curve)(curve.knots, np.eye(len(curve.controls)))(u)
    control = int(share.argmax())
    moved = move_control(edited, control, (at - edited.time(np.array(8.0))) / share[control])
    assert_allclose(played(moved)[8], pose.vertices, atol=1e-6)


def test_a_pose_that_mixtures_show_needs_no_component() -> None:
    signals = CLIPS["vertex"]
    V = played(signals)
    edited = add_pose(signals, 0.3 * V[2] + 0.7 * V[9], [0.4, 0.4])
    assert len(edited.shape.components) == len(signals.shape.components)
    sculpted = add_pose(signals, V[2] + 0.1 * np.sin(40 * V[2]), [0.4, 0.4])
    assert len(sculpted.shape.components) == len(signals.shape.components) + 1
    H = sculpted.shape.components
    assert_allclose(H @ H.T, np.eye(len(H)), atol=1e-9)


def test_where_the_body_stands_does_not_matter_once_it_was_split_off() -> None:
    signals = signals_of(bending(16, drift=1.0), placement=True)
    pose = tube(bend=(0.3, -1.2)).vertices
    there = pose @ np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]]) + [5.0, 1.0, -2.0]
    a, b = (add_pose(signals, V, [0.3, 0.3]) for V in (pose, there))
    assert_allclose(shown_at(a, np.array([0.3, 0.3])), shown_at(b, np.array([0.3, 0.3])), atol=1e-9)
    assert_array_equal(played(a), played(signals))


def test_other_meshes_and_taken_places_are_refused() -> None:
    signals = CLIPS["vertex"]
    with pytest.raises(ValueError, match="must have 56 vertices, got 83"):
        add_pose(signals, tube(sides=9), [0, 0])
    with pytest.raises(ValueError, match="at must be a place without a pose"):
        add_pose(signals, tube(), signals.pose.sites[3])
    with pytest.raises(ValueError, match="at must"):
        add_pose(signals, tube(), [0, 0, 0])
    with pytest.raises(ValueError, match="finite"):
        add_pose(signals, np.full((56, 3), np.nan), [0, 0])
