"""Motions become angles without jumps and velocities in the frame time of the training."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from clothed_tube import swing, tube_rig
from numpy.testing import assert_allclose

from tempose.clips import Skeleton, SkeletonClip
from tempose.clips.resample import resample
from tempose.detail import motion_inputs
from tempose.detail.checks import check_joints
from tempose.detail.fitting import training_inputs
from tempose.detail.inputs import nearest_turn, unwrap
from tempose.rotations import from_rotation_vector, multiply


def spinning(rates: np.ndarray, T: int, fps: float = 30.0) -> SkeletonClip:
    """Every joint turns about Z by so many radians a second."""
    skeleton = Skeleton(("a", "b"), np.array([-1, 0]), np.array([[0.0, 0, 0], [0, 1, 0]]))
    angle = np.arange(T)[:, None, None] / fps * rates[:, None] * np.array([0, 0, 1.0])
    return SkeletonClip(skeleton, from_rotation_vector(angle), np.zeros((T, 3)), fps)


def test_rest_pose_has_no_angles_whatever_the_rest_rotations() -> None:
    rest = from_rotation_vector(np.array([[0.1, 2.0, 0.3], [1.0, -0.4, 0.2]]))
    skeleton = Skeleton(("a", "b"), np.array([-1, 0]), np.array([[0.0, 0, 0], [0, 1, 0]]), rest)
    inputs = motion_inputs(SkeletonClip(skeleton, rest[None], np.zeros((1, 3))))
    assert_allclose(inputs.angles, 0.0, atol=1e-12)
    turn = from_rotation_vector(np.array([0.3, 0.2, -0.5]))
    moved = rest.copy()
    moved[1] = multiply(rest[1], turn)
    inputs = motion_inputs(SkeletonClip(skeleton, moved[None], np.zeros((1, 3))))
    assert_allclose(inputs.angles[0, 0], [0.3, 0.2, -0.5], atol=1e-12)
    assert inputs.joints == ("b",)


def test_a_joint_may_turn_several_times_over() -> None:
    inputs = motion_inputs(spinning(np.array([0.0, 9.0]), 60))
    assert_allclose(inputs.angles[:, 0, 2], 9.0 * np.arange(60) / 30, atol=1e-9)
    assert_allclose(inputs.velocity[:, 0, 2], 0.3, atol=1e-9)


@pytest.mark.parametrize("fps", [15.0, 30.0, 47.0, 60.0, 120.0])
def test_velocities_are_given_for_the_rate_of_the_training(fps: float) -> None:
    inputs = motion_inputs(spinning(np.array([0.0, 2.0]), 50, fps), 30.0)
    assert_allclose(inputs.velocity[:, 0, 2], 2.0 / 30, atol=1e-9)


def test_frames_between_frames_do_not_change_velocities() -> None:
    rig = tube_rig()
    motion = swing(rig, 30)
    twice = motion_inputs(resample(motion, 60.0), 30.0)
    once = motion_inputs(motion)
    assert_allclose(twice.angles[::2], once.angles, atol=1e-12)
    assert_allclose(twice.velocity[2::2], once.velocity[1:], atol=1e-12)


def test_first_frames_move_as_the_first_that_knows() -> None:
    motion = swing(tube_rig(), 12)
    inputs = motion_inputs(motion)
    assert_allclose(inputs.velocity[0], inputs.velocity[1])
    assert_allclose(inputs.velocity[1], inputs.angles[1] - inputs.angles[0], atol=1e-12)
    assert (motion_inputs(motion.frames(slice(0, 1))).velocity == 0).all()
    short = motion_inputs(resample(motion, 240.0).frames(slice(0, 3)), 30.0)
    assert_allclose(short.velocity[0], 4 * (short.angles[2] - short.angles[0]), atol=1e-9)


def test_unwrapping_keeps_rotations_and_removes_jumps(rng) -> None:
    path = np.cumsum(rng.normal(scale=0.3, size=(80, 4, 3)), axis=0)
    q = from_rotation_vector(path)
    angle = np.linalg.norm(path, axis=-1, keepdims=True)
    wrapped = path * (1 - 2 * np.pi / angle * np.round(angle / (2 * np.pi)))
    found = unwrap(wrapped)
    assert_allclose(np.abs((from_rotation_vector(found) * q).sum(axis=-1)), 1.0, atol=1e-12)
    again = unwrap(wrapped, path[0])
    assert_allclose(again[0], path[0], atol=1e-9)


def test_no_turn_takes_the_axis_that_is_wanted() -> None:
    near = np.array([[0.0, 0.0, 6.0], [0.0, 0.0, 0.0]])
    assert_allclose(nearest_turn(np.zeros((2, 3)), near), [[0, 0, 2 * np.pi], [0, 0, 0]], atol=1e-12)


def test_one_pose_has_one_name_in_all_clips() -> None:
    first, second = spinning(np.array([0.0, 9.0]), 40), spinning(np.array([0.0, 9.0]), 40)
    later = second.frames(np.arange(20, 40))
    inputs = training_inputs((first, later))
    assert list(np.unique(inputs.chains, return_counts=True)[1]) == [40, 20]
    assert np.abs(inputs.angles[40:] - inputs.angles[20:40]).max() < 1e-9


def test_motions_that_mean_another_pose_are_refused() -> None:
    rig = tube_rig()
    motion = swing(rig, 3)
    check_joints(rig, motion)
    longer = replace(motion.skeleton, offsets=1.2 * motion.skeleton.offsets)
    check_joints(rig, replace(motion, skeleton=longer))
    rest = np.tile([1.0, 0, 0, 0], (3, 1))
    rest[2] = from_rotation_vector(np.array([0.0, 0, np.radians(30)]))
    turned = replace(motion, skeleton=replace(motion.skeleton, rest_rotations=rest))
    with pytest.raises(ValueError, match=r"moved must rest .*'joint_2' turned by 30 deg.*match_motion"):
        check_joints(rig, turned, "moved")
    forked = replace(motion, skeleton=replace(motion.skeleton, parents=np.array([-1, 0, 0])))
    with pytest.raises(ValueError, match="hang 'joint_2'"):
        check_joints(rig, forked)
    other = replace(motion, skeleton=replace(motion.skeleton, names=("joint_0", "a", "b")))
    with pytest.raises(ValueError, match="unknown 'a'"):
        check_joints(rig, other)
