"""Linear blend skinning: rest stays, equal transforms are rigid motion, loops agree."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, linear_blend_skinning, rest_transforms
from tempose.kinematics.skinning import bake
from tempose.rotations import from_rotation_vector, multiply, rotate, to_matrix

J, N = 5, 30


@pytest.fixture
def skin(rng: np.random.Generator) -> SkinnedMesh:
    rest = rng.normal(size=(J, 4))
    rest /= np.linalg.norm(rest, axis=1, keepdims=True)
    tree = Skeleton(tuple("abcde"), np.array([-1, 0, 1, 1, 0]), rng.normal(size=(J, 3)), rest)
    weights = rng.random((N, J)) * (rng.random((N, J)) < 0.6)
    weights[:, 0] += 0.1
    weights /= weights.sum(axis=1, keepdims=True)
    return SkinnedMesh(Mesh(rng.normal(size=(N, 3)), np.array([[0, 1, 2]])), tree, weights)


def random_motion(rng: np.random.Generator, T: int = 4) -> tuple[np.ndarray, np.ndarray]:
    q = rng.normal(size=(T, J, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True), rng.normal(size=(T, 3))


def test_the_rest_pose_gives_the_rest_mesh(skin) -> None:
    posed = linear_blend_skinning(skin, skin.skeleton.rest_rotations[None], skin.skeleton.offsets[:1])
    assert_allclose(posed, skin.mesh.vertices[None], rtol=0, atol=1e-13)


def test_equal_transforms_are_rigid_motion_whatever_the_weights(skin, rng) -> None:
    turn, shift = random_motion(rng, 1)[0][0, 0], rng.normal(size=3)
    pose = skin.skeleton.rest_rotations.copy()
    pose[0] = multiply(turn, pose[0])
    root = rotate(turn, skin.skeleton.offsets[0]) + shift
    posed = linear_blend_skinning(skin, pose[None], root[None])
    assert_allclose(posed[0], rotate(turn, skin.mesh.vertices) + shift, rtol=0, atol=1e-12)


def test_agrees_with_loops_over_bones(skin, rng) -> None:
    rotations, root = random_motion(rng)
    posed = linear_blend_skinning(skin, rotations, root)
    assert posed.shape == (4, N, 3)
    bind_rotation, bind_position = rest_transforms(skin.skeleton)
    world, position = forward_kinematics(skin.skeleton, rotations, root)
    for t in range(4):
        for v in range(N):
            expected = np.zeros(3)
            for j in range(J):
                local = to_matrix(bind_rotation[j]).T @ (skin.mesh.vertices[v] - bind_position[j])
                expected += skin.weights[v, j] * (to_matrix(world[t, j]) @ local + position[t, j])
            assert_allclose(posed[t, v], expected, rtol=0, atol=1e-12)


def test_a_vertex_of_one_bone_keeps_its_distance_to_the_joint(skin, rng) -> None:
    weights = np.eye(J)[np.arange(N) % J]
    rigid = SkinnedMesh(skin.mesh, skin.skeleton, weights)
    rotations, root = random_motion(rng)
    posed = linear_blend_skinning(rigid, rotations, root)
    _, bind = rest_transforms(skin.skeleton)
    _, position = forward_kinematics(skin.skeleton, rotations, root)
    owner = np.arange(N) % J
    assert_allclose(
        np.linalg.norm(posed - position[:, owner], axis=-1),
        np.tile(np.linalg.norm(skin.mesh.vertices - bind[owner], axis=-1), (4, 1)),
        rtol=1e-12,
    )


def test_the_result_is_linear_in_the_weights(skin, rng) -> None:
    rotations, root = random_motion(rng)
    other = SkinnedMesh(skin.mesh, skin.skeleton, np.roll(skin.weights, 1, axis=1))
    half = SkinnedMesh(skin.mesh, skin.skeleton, 0.5 * (skin.weights + other.weights))
    a, b = (linear_blend_skinning(s, rotations, root) for s in (skin, other))
    assert_allclose(linear_blend_skinning(half, rotations, root), 0.5 * (a + b), rtol=0, atol=1e-13)


def test_a_vertex_bound_to_nothing_stays(skin, rng) -> None:
    weights = skin.weights.copy()
    weights[7] = 0
    loose = SkinnedMesh(skin.mesh, skin.skeleton, weights)
    motion = random_motion(rng)
    posed, others = linear_blend_skinning(loose, *motion), np.arange(N) != 7
    assert_array_equal(posed[:, 7], np.tile(skin.mesh.vertices[7], (4, 1)))
    assert_array_equal(posed[:, others], linear_blend_skinning(skin, *motion)[:, others])


@pytest.mark.parametrize("T", [0, 1, 3])
def test_frames_of_a_batch_equal_single_frames(skin, rng, T: int) -> None:
    rotations, root = random_motion(rng, T)
    batch = linear_blend_skinning(skin, rotations, root)
    assert batch.shape == (T, N, 3)
    for t in range(T):
        one = linear_blend_skinning(skin, rotations[t : t + 1], root[t : t + 1])
        assert_allclose(batch[t], one[0], rtol=0, atol=1e-14)


def test_longer_bones_of_the_motion_carry_the_vertices_along(skin, rng) -> None:
    tree = skin.skeleton
    longer = Skeleton(tree.names, tree.parents, 2 * tree.offsets, tree.rest_rotations)
    weights = np.eye(J)[np.arange(N) % J]
    rigid = SkinnedMesh(skin.mesh, tree, weights)
    pose, root = random_motion(rng)
    shift = forward_kinematics(longer, pose, root)[1] - forward_kinematics(tree, pose, root)[1]
    near, far = linear_blend_skinning(rigid, pose, root), linear_blend_skinning(rigid, pose, root, longer)
    assert_allclose(far - near, shift[:, np.arange(N) % J], rtol=0, atol=1e-12)
    clip = SkeletonClip(longer, pose, root)
    assert_array_equal(bake(rigid, clip), far)


def test_a_small_turn_moves_vertices_by_the_weighted_cross_product(skin, rng) -> None:
    rest, root = skin.skeleton.rest_rotations, skin.skeleton.offsets[:1]
    world, position = rest_transforms(skin.skeleton)
    h, axis = 1e-6, rng.normal(size=3)
    ends = []
    for sign in (1, -1):
        pose = rest.copy()
        pose[3] = multiply(rest[3], from_rotation_vector(sign * h * axis))  # joint d has no children
        ends.append(linear_blend_skinning(skin, pose[None], root)[0])
    arm = skin.mesh.vertices - position[3]
    expected = skin.weights[:, 3:4] * np.cross(rotate(world[3], axis), arm)
    assert_allclose((ends[0] - ends[1]) / (2 * h), expected, rtol=0, atol=1e-8)


def test_a_clip_of_other_joints_is_refused(skin) -> None:
    tree = Skeleton(("x", "y"), np.array([-1, 0]), np.zeros((2, 3)))
    clip = SkeletonClip(tree, np.tile([1.0, 0, 0, 0], (1, 2, 1)), np.zeros((1, 3)))
    with pytest.raises(ValueError, match="clip must move the 5 joints of the skin, got 2 joints, first 'x'"):
        bake(skin, clip)
