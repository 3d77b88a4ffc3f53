"""Joints come back to where a clip turns about them; what the clip does not tell stays."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from pose_cases import J, posed, random_motion, random_skin

from tempose.clips import SkeletonClip
from tempose.kinematics import bone_transforms, rest_transforms
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.pose_fit.moments import SkinMoments
from tempose.rigging.refine import refine_joints
from tempose.rigging.refine.joints import solve_joints, subtrees, with_joints
from tempose.rotations import from_rotation_vector, multiply, rotate, to_matrix


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_moved_joints_come_back(rng, unit) -> None:
    truth = random_skin(rng, unit, at=3.0)
    Y = posed(truth, random_motion(truth, rng, 25))
    joints = rest_transforms(truth.skeleton)[1]
    start = with_joints(truth, joints + 0.05 * unit * rng.normal(size=joints.shape))
    found = refine_joints(start, None, Y, rounds=40, pull=1e-8)
    assert found.rms[0] > 1e-3 * unit and found.rms[-1] < 0.01 * found.rms[0]
    assert (np.diff(found.rms) < 0).all()
    # the root's own place is free: its turns and translations make up for it
    back = rest_transforms(found.skin.skeleton)[1]
    assert_allclose(back[1:], joints[1:], rtol=0, atol=2e-3 * unit)


def test_one_solution_is_that_of_dense_least_squares(rng) -> None:
    skin = random_skin(rng)
    T = 5
    rotations, root = random_motion(skin, rng, T)
    Y = posed(skin, (rotations, root)) + 0.1 * rng.normal(size=(T, len(skin.weights), 3))
    made = SkinMoments(skin)
    found = solve_joints(made, made.frames(Y), SkeletonClip(skin.skeleton, rotations, root), pull=0.0)
    R = to_matrix(bone_transforms(skin.skeleton, rotations, root)[0])
    s = skin.weights @ subtrees(skin.skeleton).T
    n = len(s)
    rows, left = np.zeros((T, n, 3, 3 * (J - 1) + 3 * T)), np.zeros((T, n, 3))
    for t in range(T):
        turned = np.einsum("nk,kab,nb->na", skin.weights, R[t], skin.mesh.vertices)
        left[t] = Y[t] - turned
        for j in range(1, J):
            D = R[t, skin.skeleton.parents[j]] - R[t, j]
            rows[t, :, :, 3 * (j - 1) : 3 * j] = s[:, j, None, None] * D
        rows[t, :, :, 3 * (J - 1) + 3 * t : 3 * J + 3 * t] = np.eye(3)
    solved = np.linalg.lstsq(rows.reshape(-1, rows.shape[-1]), left.ravel(), rcond=None)[0]
    assert_allclose(found[1:], solved[: 3 * (J - 1)].reshape(-1, 3), rtol=0, atol=1e-8)
    assert_array_equal(found[0], rest_transforms(skin.skeleton)[1][0])


def test_a_joint_moves_neither_along_its_hinge_nor_when_it_is_still(rng) -> None:
    skin = random_skin(rng)
    T = 12
    rotations = np.tile(skin.skeleton.rest_rotations, (T, 1, 1))
    hinge = rng.normal(size=3)
    turn = np.linspace(-1, 1, T)[:, None] * hinge / np.linalg.norm(hinge)
    rotations[:, 4] = multiply(rotations[:, 4], from_rotation_vector(turn))
    Y = posed(skin, (rotations, np.zeros((T, 3))))
    world, joints = rest_transforms(skin.skeleton)
    start = with_joints(skin, joints + 0.05 * rng.normal(size=joints.shape) * (np.arange(J) == 4)[:, None])
    found = refine_joints(start, None, Y, rounds=30, pull=1e-6)
    step = rest_transforms(found.skin.skeleton)[1] - rest_transforms(start.skeleton)[1]
    axis = rotate(world[4], hinge / np.linalg.norm(hinge))
    assert abs(step[4] @ axis) < 1e-3 and np.linalg.norm(step[4]) > 0.02
    assert_allclose(step[[1, 2, 3, 5]], 0, atol=2e-3)


def test_right_joints_stay(rng) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng))
    found = refine_joints(skin, None, Y)
    assert found.moved.max() < 1e-6 and found.rms[-1] < 1e-6


def test_the_result_is_a_skin_of_the_same_mesh_fitted_to_the_clip(rng) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng, 10)) + 0.05 * rng.normal(size=(10, len(skin.weights), 3))
    motion = fit_poses(skin, Y, fps=24.0).motion
    found = refine_joints(skin, motion, Y)
    assert found.skin.mesh is skin.mesh and found.fit.motion.fps == 24.0
    assert_array_equal(found.skin.weights, skin.weights)
    again = posed(found.skin, (found.fit.motion.rotations, found.fit.motion.root_position))
    assert_allclose(np.sqrt(((again - Y) ** 2).sum(axis=2).mean()), found.rms[-1], rtol=1e-9)
    assert found.rms[-1] < found.rms[0]


def test_ends_of_bones_stay_where_they_are(rng) -> None:
    skin = random_skin(rng)
    world, joints = rest_transforms(skin.skeleton)
    moved = with_joints(skin, joints + rng.normal(size=joints.shape))
    after_world, after = rest_transforms(moved.skeleton)
    assert_allclose(after_world, world, atol=1e-12)
    assert_allclose(
        after + rotate(after_world, moved.skeleton.tips),
        joints + rotate(world, skin.skeleton.tips),
        atol=1e-12,
    )


def test_subtrees_are_marked(rng) -> None:
    below = subtrees(random_skin(rng).skeleton)
    assert_array_equal(below[0], np.ones(J))
    assert_array_equal(below[1], [0, 1, 1, 1, 0, 0])
    assert_array_equal(below[5], [0, 0, 0, 0, 0, 1])


def test_no_rounds_only_fit_and_fewer_are_refused(rng) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng))
    assert_array_equal(refine_joints(skin, None, Y, rounds=0).moved, np.zeros(J))
    with pytest.raises(ValueError, match="rounds must not be negative, got -1"):
        refine_joints(skin, None, Y, rounds=-1)
