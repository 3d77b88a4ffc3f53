"""Dual-quaternion skinning: rest stays, rigid motion is exact, blends are rigid, loops agree."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics import (
    bone_transforms,
    dual_quaternion_skinning,
    linear_blend_skinning,
    local_rotations,
)
from tempose.kinematics.dual_quaternion import dual_quaternions
from tempose.rotations import angle_between, conjugate, from_rotation_vector, multiply, rotate

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


def small_motion(skin: SkinnedMesh, rng: np.random.Generator, T: int = 4) -> tuple[np.ndarray, np.ndarray]:
    turn = from_rotation_vector(0.4 * rng.normal(size=(T, J, 3)))
    return multiply(skin.skeleton.rest_rotations, turn), rng.normal(size=(T, 3))


def test_the_rest_pose_gives_the_rest_mesh(skin) -> None:
    posed = dual_quaternion_skinning(skin, skin.skeleton.rest_rotations[None], skin.skeleton.offsets[:1])
    assert_allclose(posed, skin.mesh.vertices[None], rtol=0, atol=1e-13)


@pytest.mark.parametrize("sign", [1, -1])
def test_equal_transforms_are_rigid_motion_whatever_the_sign(skin, rng, sign) -> None:
    turn, shift = from_rotation_vector(rng.normal(size=3)), rng.normal(size=3)
    pose = skin.skeleton.rest_rotations.copy()
    pose[0] = sign * multiply(turn, pose[0])
    root = rotate(turn, skin.skeleton.offsets[0]) + shift
    posed = dual_quaternion_skinning(skin, pose[None], root[None])
    assert_allclose(posed[0], rotate(turn, skin.mesh.vertices) + shift, rtol=0, atol=1e-12)


def test_a_vertex_of_one_bone_agrees_with_linear_blending(skin, rng) -> None:
    rigid = SkinnedMesh(skin.mesh, skin.skeleton, np.eye(J)[np.arange(N) % J])
    motion = small_motion(skin, rng)
    assert_allclose(
        dual_quaternion_skinning(rigid, *motion), linear_blend_skinning(rigid, *motion), rtol=0, atol=1e-12
    )


def test_agrees_with_the_blend_written_out_in_quaternions(skin, rng) -> None:
    rotations, root = small_motion(skin, rng)
    posed = dual_quaternion_skinning(skin, rotations, root)
    flipped = rotations * rng.choice([-1.0, 1.0], size=(4, J, 1))
    assert_allclose(dual_quaternion_skinning(skin, flipped, root), posed, rtol=0, atol=1e-13)
    turns, shifts = bone_transforms(skin.skeleton, rotations, root)
    real, dual = dual_quaternions(turns, shifts)
    for t in range(len(root)):
        for v in range(N):
            w = skin.weights[v]
            signs = np.where(real[t] @ real[t, w.argmax()] < 0, -w, w)
            r, d = signs @ real[t], signs @ dual[t]
            size = np.linalg.norm(r)
            r, d = r / size, d / size
            d = d - (r @ d) * r
            expected = rotate(r, skin.mesh.vertices[v]) + 2 * multiply(d, conjugate(r))[1:]
            assert_allclose(posed[t, v], expected, rtol=0, atol=1e-12)


def test_a_twisted_joint_keeps_its_radius_where_linear_blending_loses_it() -> None:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ring = np.stack([np.full(12, 0.5), np.cos(angle), np.sin(angle)], axis=1)
    tree = Skeleton(("a", "b"), np.array([-1, 0]), np.array([[0.0, 0, 0], [0.5, 0, 0]]))
    skin = SkinnedMesh(Mesh(ring, np.array([[0, 1, 2]])), tree, np.full((12, 2), 0.5))
    pose = from_rotation_vector(np.array([[0, 0, 0], [2.0, 0, 0]]))
    half = rotate(from_rotation_vector(np.array([1.0, 0, 0])), ring)
    posed = dual_quaternion_skinning(skin, pose[None], np.zeros((1, 3)))[0]
    assert_allclose(posed, half, rtol=0, atol=1e-12)
    linear = linear_blend_skinning(skin, pose[None], np.zeros((1, 3)))[0]
    assert_allclose(np.linalg.norm(linear[:, 1:], axis=1), np.cos(1.0), rtol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_of_length_does_not_matter(skin, rng, unit) -> None:
    rotations, root = small_motion(skin, rng)
    tree = skin.skeleton
    scaled = SkinnedMesh(
        Mesh(unit * skin.mesh.vertices, skin.mesh.faces),
        Skeleton(tree.names, tree.parents, unit * tree.offsets, tree.rest_rotations),
        skin.weights,
    )
    posed = dual_quaternion_skinning(scaled, rotations, unit * root)
    assert_allclose(posed, unit * dual_quaternion_skinning(skin, rotations, root), rtol=0, atol=1e-11 * unit)


def test_a_vertex_bound_to_nothing_stays(skin, rng) -> None:
    weights = skin.weights.copy()
    weights[7] = 0
    loose = SkinnedMesh(skin.mesh, skin.skeleton, weights)
    motion = small_motion(skin, rng)
    posed = dual_quaternion_skinning(loose, *motion)
    assert_array_equal(posed[:, 7], np.tile(skin.mesh.vertices[7], (4, 1)))


@pytest.mark.parametrize("T", [0, 1])
def test_short_clips_keep_their_shape(skin, rng, T) -> None:
    assert dual_quaternion_skinning(skin, *small_motion(skin, rng, T)).shape == (T, N, 3)


def test_turns_of_bones_give_their_local_rotations_back(skin, rng) -> None:
    rotations, root = small_motion(skin, rng)
    turns, _ = bone_transforms(skin.skeleton, rotations, root)
    back = local_rotations(skin.skeleton, turns)
    assert_allclose(angle_between(back, rotations), 0, atol=1e-7)
