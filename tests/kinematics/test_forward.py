"""Forward kinematics: closed forms, rigid bones, frames as in a batch, derivatives by differences."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Skeleton
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import IDENTITY, conjugate, from_rotation_vector, multiply, rotate, to_matrix


def random_skeleton(rng: np.random.Generator, J: int = 9) -> Skeleton:
    parents = np.array([-1, *(int(rng.integers(j)) for j in range(1, J))])
    rest = rng.normal(size=(J, 4))
    rest /= np.linalg.norm(rest, axis=1, keepdims=True)
    return Skeleton(tuple(f"j{j}" for j in range(J)), parents, rng.normal(size=(J, 3)), rest)


def random_pose(rng: np.random.Generator, *shape: int) -> np.ndarray:
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def test_the_identity_pose_sums_the_offsets(rng) -> None:
    tree = random_skeleton(rng)
    root = np.array([1.0, 2, 3])
    world, positions = forward_kinematics(tree, np.tile(IDENTITY, (9, 1)), root)
    assert_array_equal(world, np.tile(IDENTITY, (9, 1)))
    for j in range(9):
        expected, k = root.copy(), j
        while k != 0:
            expected += tree.offsets[k]
            k = int(tree.parents[k])
        assert_allclose(positions[j], expected, rtol=0, atol=1e-14)


def test_an_elbow_bent_by_a_right_angle() -> None:
    arm = Skeleton(
        ("shoulder", "elbow", "hand"), np.array([-1, 0, 1]), np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0]])
    )
    bend = from_rotation_vector(np.array([[0, 0, 0], [0, 0, np.pi / 2], [0, 0, 0]]))
    world, positions = forward_kinematics(arm, bend, np.array([0, 5.0, 0]))
    assert_allclose(positions, [[0, 5, 0], [2, 5, 0], [2, 6, 0]], rtol=0, atol=1e-15)
    assert_allclose(rotate(world[2], np.array([1.0, 0, 0])), [0, 1, 0], rtol=0, atol=1e-15)


def test_bones_keep_their_length_in_every_pose(rng) -> None:
    tree = random_skeleton(rng)
    _, positions = forward_kinematics(tree, random_pose(rng, 50, 9), rng.normal(size=(50, 3)))
    bones = positions[:, 1:] - positions[:, tree.parents[1:]]
    expected = np.linalg.norm(tree.offsets[1:], axis=1)
    assert_allclose(np.linalg.norm(bones, axis=-1), np.tile(expected, (50, 1)), rtol=1e-12)


def test_agrees_with_products_of_4_by_4_matrices(rng) -> None:
    tree, pose, root = random_skeleton(rng), random_pose(rng, 4, 9), rng.normal(size=(4, 3))
    world, positions = forward_kinematics(tree, pose, root)
    for t in range(4):
        matrices: list[np.ndarray] = []
        for j in range(9):
            local = np.eye(4)
            local[:3, :3] = to_matrix(pose[t, j])
            local[:3, 3] = root[t] if j == 0 else tree.offsets[j]
            matrices.append(local if j == 0 else matrices[int(tree.parents[j])] @ local)
            assert_allclose(to_matrix(world[t, j]), matrices[j][:3, :3], rtol=0, atol=1e-13)
            assert_allclose(positions[t, j], matrices[j][:3, 3], rtol=0, atol=1e-13)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_batches_equal_single_frames(rng, shape: tuple[int, ...]) -> None:
    tree, pose, root = random_skeleton(rng), random_pose(rng, *shape, 9), rng.normal(size=(*shape, 3))
    world, positions = forward_kinematics(tree, pose, root)
    assert world.shape == (*shape, 9, 4) and positions.shape == (*shape, 9, 3)
    for index in np.ndindex(shape):
        one_world, one_positions = forward_kinematics(tree, pose[index], root[index])
        assert_array_equal(world[index], one_world)
        assert_array_equal(positions[index], one_positions)


def test_moving_the_root_moves_the_body_rigidly(rng) -> None:
    tree, pose, root = random_skeleton(rng), random_pose(rng, 9), rng.normal(size=3)
    world, positions = forward_kinematics(tree, pose, root)
    turn, shift = random_pose(rng), rng.normal(size=3)
    moved = pose.copy()
    moved[0] = multiply(turn, pose[0])
    world2, positions2 = forward_kinematics(tree, moved, rotate(turn, root) + shift)
    assert_allclose(positions2, rotate(turn, positions) + shift, rtol=0, atol=1e-13)
    assert_allclose(world2, multiply(turn, world), rtol=0, atol=1e-13)


def test_a_joint_moves_only_what_hangs_on_it(rng) -> None:
    tree, pose = random_skeleton(rng), random_pose(rng, 9)
    below = {4}
    for j in range(5, 9):
        if int(tree.parents[j]) in below:
            below.add(j)
    turned = pose.copy()
    turned[4] = random_pose(rng)
    world, positions = forward_kinematics(tree, pose, np.zeros(3))
    world2, positions2 = forward_kinematics(tree, turned, np.zeros(3))
    for j in range(9):
        assert np.array_equal(world[j], world2[j]) == (j not in below)
        assert np.array_equal(positions[j], positions2[j]) == (j not in below - {4})


def test_the_derivative_by_a_joint_is_the_cross_product_with_its_axis(rng) -> None:
    tree, pose = random_skeleton(rng), random_pose(rng, 9)
    world, positions = forward_kinematics(tree, pose, np.zeros(3))
    h = 1e-6
    for j in range(9):
        hangs = np.zeros(9, dtype=bool)
        hangs[j] = True
        for k in range(j + 1, 9):
            hangs[k] = hangs[int(tree.parents[k])]
        for axis in np.eye(3):
            ends = []
            for sign in (1, -1):
                turned = pose.copy()
                turned[j] = multiply(pose[j], from_rotation_vector(sign * h * axis))
                ends.append(forward_kinematics(tree, turned, np.zeros(3))[1])
            expected = np.cross(rotate(world[j], axis), positions - positions[j]) * hangs[:, None]
            assert_allclose((ends[0] - ends[1]) / (2 * h), expected, rtol=0, atol=1e-8)


def test_the_input_is_left_alone(rng) -> None:
    tree, pose = random_skeleton(rng), random_pose(rng, 2, 9)
    before = pose.copy()
    forward_kinematics(tree, pose, np.zeros((2, 3)))
    assert_array_equal(pose, before)


def test_rest_transforms_are_the_rest_pose_at_its_place(rng) -> None:
    tree = random_skeleton(rng)
    assert tree.rest_rotations is not None
    world, positions = rest_transforms(tree)
    assert_array_equal(positions[0], tree.offsets[0])
    expected = forward_kinematics(tree, tree.rest_rotations, tree.offsets[0])
    assert_array_equal(world, expected[0])
    assert_array_equal(positions, expected[1])
    back = multiply(conjugate(world[tree.parents[1:]]), world[1:])
    assert_allclose(back, tree.rest_rotations[1:], rtol=0, atol=1e-13)


def test_one_joint_is_its_root() -> None:
    tree = Skeleton(("root",), np.array([-1]), np.array([[9.0, 9, 9]]))
    world, positions = forward_kinematics(tree, IDENTITY[None], np.array([1.0, 2, 3]))
    assert_array_equal(positions, [[1, 2, 3]])
    assert_array_equal(world, IDENTITY[None])
