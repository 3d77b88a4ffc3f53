"""Joints, trees and skeletons of clips whose skeleton is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bone_cases import chain, matched
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import bone_transforms, rest_transforms
from tempose.kinematics.skinning import bake
from tempose.rigging.decomposition import Decomposition
from tempose.rigging.joints import auto_skin, pair_joints, settle, skeleton_from_bones
from tempose.rigging.joints.seams import distinct_vertices
from tempose.rotations import from_rotation_vector, to_matrix


def as_bones(skin, motion) -> Decomposition:
    turns, shifts = bone_transforms(skin.skeleton, motion.rotations, motion.root_position)
    return Decomposition(skin.mesh.vertices, skin.weights, turns, shifts, 0.0, 0, True)


@pytest.fixture(scope="module")
def bent():
    return chain(5, 20, np.random.default_rng(5))


def test_neighbours_meet_where_the_joint_is(bent):
    skin, motion, _ = bent
    pairs = pair_joints(as_bones(skin, motion))
    P = rest_transforms(skin.skeleton)[1]
    for j in range(1, 5):
        assert_allclose(pairs.places[j - 1, j], P[j], atol=0.01)
        assert pairs.apart[j - 1, j] < 0.01
        assert pairs.apart[j - 1, j] < 0.1 * pairs.apart[j - 1, (j + 2) % 5]
    for array in (pairs.apart, pairs.stray, pairs.shared):
        assert_allclose(array, array.T, atol=1e-9)


def test_joints_are_found_aside_of_what_both_bones_hold(bent):
    skin, motion, _ = bent
    aside = Skeleton(
        skin.skeleton.names, skin.skeleton.parents, skin.skeleton.offsets + np.eye(5, 1) * [[0.05, 0.2, 0.0]]
    )
    pairs = pair_joints(as_bones(SkinnedMesh(skin.mesh, aside, skin.weights), motion))
    P = rest_transforms(aside)[1]
    found = np.array([pairs.places[j - 1, j] for j in range(1, 5)])
    assert_allclose(found, P[1:], atol=0.02)
    assert_allclose(pairs.stray[0, 1], np.hypot(0.05, 0.2), atol=0.02)


def test_a_hinge_keeps_its_joint_in_the_mesh(bent):
    skin, _, _ = bent
    rng = np.random.default_rng(0)
    turns = np.zeros((12, 5, 3))
    turns[..., 2] = 0.5 * rng.standard_normal((12, 5))
    motion = SkeletonClip(skin.skeleton, from_rotation_vector(turns), np.zeros((12, 3)))
    pairs = pair_joints(as_bones(skin, motion))
    P = rest_transforms(skin.skeleton)[1]
    found = np.array([pairs.places[j - 1, j] for j in range(1, 5)])
    assert_allclose(found[:, :2], P[1:, :2], atol=0.01)
    assert np.abs(found[:, 2]).max() < 0.05


def test_bones_that_hardly_turn_have_their_joint_where_both_hold_the_mesh(bent):
    skin, _, _ = bent
    rng = np.random.default_rng(0)
    motion = SkeletonClip(
        skin.skeleton, from_rotation_vector(5e-3 * rng.standard_normal((12, 5, 3))), np.zeros((12, 3))
    )
    bones = as_bones(skin, motion)
    # flesh slides by as much as a joint ten units away would make it
    slid = replace(bones, translations=bones.translations + 0.05 * rng.standard_normal((12, 5, 3)))
    pairs = pair_joints(slid)
    assert max(pairs.stray[j - 1, j] for j in range(1, 5)) < 0.05


def test_bones_of_a_chain_hang_as_in_the_chain(bent):
    skin, motion, _ = bent
    shuffled = [3, 1, 4, 0, 2]
    true = as_bones(skin, motion)
    bones = Decomposition(
        true.rest,
        true.weights[:, shuffled],
        true.rotations[:, shuffled],
        true.translations[:, shuffled],
        0.0,
        0,
        True,
    )
    skeleton, weights, found = skeleton_from_bones(bones)
    order = matched(weights, skin.weights)
    links = {frozenset((b, int(skeleton.parents[b]))) for b in range(1, 5)}
    assert links == {frozenset((order[j - 1], order[j])) for j in range(1, 5)}
    assert order[2] == 0  # the middle is the root
    assert skeleton.names == ("bone_00", "bone_01", "bone_02", "bone_03", "bone_04")
    turns, _ = bone_transforms(skeleton, found.rotations, found.root_position)
    assert_allclose(
        to_matrix(turns),
        to_matrix(bones.rotations[:, [shuffled.index(order.index(b)) for b in range(5)]]),
        atol=1e-9,
    )
    assert np.isfinite(skeleton.tips[[order[0], order[4]]]).all()


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_frames_alone_give_the_skeleton_back(unit):
    skin, _, clip = chain(3, 10, np.random.default_rng(7), unit)
    found, report = auto_skin(clip, 3)
    assert report["bones"] == 3 and report["warnings"] == []
    assert report["e_rms"] < 0.5
    order = matched(found.weights, skin.weights)
    joints, P = rest_transforms(found.skeleton)[1] / unit, rest_transforms(skin.skeleton)[1] / unit
    below = {frozenset((b, int(found.skeleton.parents[b]))): joints[b] for b in range(1, 3)}
    for j in (1, 2):
        assert_allclose(below[frozenset((order[j - 1], order[j]))], P[j], atol=0.03)


def test_settling_never_gets_worse_and_lengths_stay(bent):
    skin, motion, clip = bent
    rng = np.random.default_rng(2)
    off = Skeleton(
        skin.skeleton.names,
        skin.skeleton.parents,
        skin.skeleton.offsets + 0.05 * rng.standard_normal((5, 3)),
    )
    frames = clip.vertices.astype(float)
    done = settle(skin.mesh.vertices, off, skin.weights, motion, frames, pull=1e-3, rounds=5)
    assert (np.diff(done.rms) <= 0).all() and done.rms[-1] < 0.2 * done.rms[0] + 1e-6
    assert_allclose(done.vertices, bake(done.skin, done.motion))
    assert ((done.skin.weights > 0).sum(axis=1) <= 4).all()


def test_seams_get_one_answer_and_parting_vertices_two(rng):
    V = rng.standard_normal((6, 3))
    rest = V[[0, 1, 2, 2, 3, 4, 5, 5]]
    frames = np.stack([rest, 2 * rest, rest + 1])
    frames[2, 7] += 0.1
    first, back = distinct_vertices(rest, frames)
    assert_allclose(frames[:, first][:, back], frames)
    assert len(first) == 7 and back[2] == back[3] and back[6] != back[7]


def test_a_cut_mesh_stays_closed():
    _, _, clip = chain(2, 6, np.random.default_rng(8))
    doubled = np.concatenate([np.arange(len(clip.rest)), np.arange(200)])
    cut = MeshClip(clip.vertices[:, doubled], Mesh(clip.rest[doubled], clip.faces))
    found, _ = auto_skin(cut, 2)
    assert np.array_equal(found.weights[:200], found.weights[len(clip.rest) :])


def test_still_and_rigid_clips_are_refused(bent):
    mesh = bent[0].mesh
    with pytest.raises(ValueError, match="at least two frames"):
        auto_skin(MeshClip(mesh.vertices[None].astype(np.float32), mesh))
    still = MeshClip(np.repeat(mesh.vertices[None], 4, axis=0).astype(np.float32), mesh)
    with pytest.raises(ValueError, match="moves as one rigid body"):
        auto_skin(still)
