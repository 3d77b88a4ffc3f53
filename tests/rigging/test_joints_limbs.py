"""Limbs that move alike: each is a chain of its own, hung where the surface says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bone_cases import chain_weights, tube
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import bone_transforms
from tempose.kinematics.skinning import bake
from tempose.rigging.decomposition import Decomposition
from tempose.rigging.joints import auto_skin, skeleton_from_bones
from tempose.rigging.joints.regions import held_pieces, part_limbs, surface_gaps
from tempose.rigging.joints.surface import surface_links
from tempose.rotations import from_rotation_vector

PARENTS = [-1, 0, 0, 2, 0, 4]  # hips, chest, left thigh and shin, right thigh and shin


def walker(unit: float = 1.0) -> tuple[SkinnedMesh, SkeletonClip, MeshClip]:
    """A body along x and two legs beside it that swing exactly alike: six bones, four motions."""
    V, F = tube(2)
    down = np.column_stack([V[:, 1], -V[:, 0], V[:, 2]])
    legs = [down + np.array([0.5, -0.3, z]) for z in (0.5, -0.5)]
    two = chain_weights(V, 2)
    weights = np.zeros((3 * len(V), 6))
    for k in range(3):
        weights[k * len(V) : (k + 1) * len(V), 2 * k : 2 * k + 2] = two
    mesh = Mesh(unit * np.concatenate([V, *legs]), np.concatenate([F + k * len(V) for k in range(3)]))
    offsets = unit * np.array(
        [[0, 0, 0], [1, 0, 0], [0.5, -0.3, 0.5], [0, -1, 0], [0.5, -0.3, -0.5], [0, -1, 0]]
    )
    names = ("hips", "chest", "left thigh", "left shin", "right thigh", "right shin")
    skeleton = Skeleton(names, np.array(PARENTS), offsets)
    rng = np.random.default_rng(3)
    turns = 0.4 * rng.standard_normal((16, 6, 3))
    turns[:, 2:, :2] = 0  # hinges about one line, so that both legs make the same rigid motions
    turns[:, 4:] = turns[:, 2:4]
    motion = SkeletonClip(skeleton, from_rotation_vector(turns), unit * rng.standard_normal((16, 3)))
    skin = SkinnedMesh(mesh, skeleton, weights)
    return skin, motion, MeshClip(bake(skin, motion), mesh)


def bones_of(skin: SkinnedMesh, motion: SkeletonClip) -> Decomposition:
    turns, shifts = bone_transforms(skin.skeleton, motion.rotations, motion.root_position)
    return Decomposition(skin.mesh.vertices, skin.weights, turns, shifts, 0.0, 0, True)


def links_between(weights: np.ndarray, true: np.ndarray, parents: np.ndarray) -> set[frozenset[int]]:
    """Edges of a found tree as pairs of true bones."""
    of = (weights.T @ true).argmax(axis=1)
    return {frozenset((int(of[b]), int(of[p]))) for b, p in enumerate(parents) if p >= 0}


def true_links() -> set[frozenset[int]]:
    return {frozenset((b, p)) for b, p in enumerate(PARENTS) if p >= 0}


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_limbs_that_move_alike_hang_each_in_its_own_chain(unit: float):
    skin, motion, _ = walker(unit)
    skeleton, weights, _ = skeleton_from_bones(bones_of(skin, motion), skin.mesh.faces)
    assert links_between(weights, skin.weights, skeleton.parents) == true_links()


def test_one_bone_in_two_limbs_becomes_two():
    skin, motion, clip = walker()
    true = bones_of(skin, motion)
    W = true.weights
    merged = replace(
        true,
        weights=np.column_stack([W[:, 0], W[:, 1], W[:, 2] + W[:, 4], W[:, 3] + W[:, 5]]),
        rotations=true.rotations[:, :4],
        translations=true.translations[:, :4],
    )
    assert_allclose(merged.vertices(), clip.vertices, atol=1e-5)
    links = surface_links(merged.rest, skin.mesh.faces)
    parted, allowed = part_limbs(merged, links)
    assert (parted.weights[~allowed] == 0).all() and allowed.sum(axis=1).tolist() == [4] * len(W)
    assert_allclose(parted.vertices(), merged.vertices(), atol=1e-12)
    assert parted.n_bones == 6
    assert np.array_equal(np.sort(parted.weights.sum(axis=0)), np.sort(W.sum(axis=0)))
    assert part_limbs(true, links)[0] is true


def test_a_clip_of_limbs_that_move_alike_gets_both():
    skin, _, clip = walker()
    found, report = auto_skin(clip)
    assert report["bones"] == found.skeleton.n_joints >= 6
    held = [found.weights[:, b] @ skin.weights[:, [2, 3, 4, 5]] for b in range(report["bones"])]
    sides = np.array([[h[:2].sum(), h[2:].sum()] for h in held])
    legs = sides.max(axis=1) > 1
    assert legs.sum() == 4 and (sides[legs].min(axis=1) == 0).all()
    for b, p in enumerate(found.skeleton.parents):
        if p >= 0 and legs[b] and legs[p]:
            assert sides[b].argmax() == sides[p].argmax()


def test_gaps_are_ways_along_the_surface():
    V, F = tube(5)
    W = chain_weights(V, 5, 1e-9)
    gaps = surface_gaps(W, surface_links(V, F))
    assert_allclose(gaps, gaps.T)
    steps = np.abs(np.subtract.outer(np.arange(5), np.arange(5)))
    assert (gaps[steps <= 1] == 0).all()
    assert_allclose(gaps[0, 2:], np.arange(1, 4), atol=0.2)  # rings are 1/12 apart
    assert_allclose(surface_gaps(W, surface_links(1e3 * V, F)), 1e3 * gaps, rtol=1e-9)


def test_pieces_are_bridged_once_to_their_nearest_neighbour():
    x = np.array([0.0, 1, 2, 5, 6, 10, 11])
    V = np.column_stack([x, np.zeros((7, 2))])
    F = np.array([[0, 1, 2], [3, 4, 3], [5, 6, 5]])
    links = surface_links(V, F).toarray()
    assert_allclose(links, links.T)
    assert links[2, 3] == 3 and links[4, 5] == 4
    assert (links[[0, 1, 2]][:, [5, 6]] == 0).all()
    points = surface_links(V, np.zeros((0, 3), dtype=int)).toarray()
    assert np.array_equal(np.argwhere(np.triu(points) > 0)[:, 0], np.arange(6))


def test_strays_are_no_limbs():
    skin, motion, _ = walker()
    W = np.array(skin.weights)
    W[-3:] = 0
    W[-3:, 3] = 1  # a few vertices of the right foot follow the left shin
    links = surface_links(skin.mesh.vertices, skin.mesh.faces)
    assert len(held_pieces(W, links, 3)) == 1
    bones = replace(bones_of(skin, motion), weights=W)
    assert part_limbs(bones, links)[0] is bones
