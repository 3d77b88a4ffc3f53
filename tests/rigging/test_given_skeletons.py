"""Given skeletons: taken as they are, brought inside, or refused with a measure."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from rig_bodies import chain, human_skin, random_rig, tube

from tempose.clips import Mesh, MeshClip, Skeleton, SkinnedMesh, Source
from tempose.embedding import Embedding, embed_skeleton
from tempose.kinematics import find_roles, rest_transforms
from tempose.rigging import fit_rig
from tempose.rigging.skeletons import bind, given_skin, joint_bones, normalised_weights, read_skeleton
from tempose.rigging.skeletons.inside import joints_outside, mesh_cells, share_inside
from tempose.rigging.skeletons.place import place_skeleton, similar_skeleton
from tempose.rigging.skeletons.posed import posed_like
from tempose.rotations import IDENTITY, angle_between, from_rotation_vector, rotate


@lru_cache
def embedded() -> Embedding:
    return embed_skeleton(human_skin().mesh)


def positions(skeleton: Skeleton) -> np.ndarray:
    return rest_transforms(skeleton)[1]


def star(size: float = 1.0) -> Skeleton:
    """Long bones from one joint in six directions: fits into no tube."""
    ways = size * np.concatenate([np.eye(3), -np.eye(3)])
    offsets = np.concatenate([np.zeros((1, 3)), ways])
    names = ("centre", "a", "b", "c", "d", "e", "f")
    return Skeleton(names, np.array([-1, 0, 0, 0, 0, 0, 0]), offsets)


def test_bones_run_to_every_child_and_to_tips() -> None:
    segments, owner = joint_bones(chain())
    assert_array_equal(owner, [0, 1, 2])
    assert_allclose(segments[:, :, 1], [[0.1, 0.7], [0.7, 1.4], [1.4, 1.9]], atol=1e-12)
    segments, owner = joint_bones(star())
    assert_array_equal(owner, [0] * 6 + [1, 2, 3, 4, 5, 6])
    assert_array_equal(segments[6:, 0], segments[6:, 1])


def test_what_stands_above_the_hips_has_no_bone() -> None:
    skin = human_skin()
    old = skin.skeleton
    assert old.rest_rotations is not None and old.tips is not None
    above = Skeleton(
        ("root", *old.names),
        np.concatenate([[-1], old.parents + 1]),
        np.concatenate([np.zeros((1, 3)), old.offsets]),
        np.concatenate([IDENTITY[None], old.rest_rotations]),
        np.concatenate([np.full((1, 3), np.nan), old.tips]),
    )
    assert 0 not in joint_bones(above)[1]
    assert_allclose(joint_bones(above)[0], joint_bones(old)[0], atol=1e-12)


def test_the_share_inside_is_the_share_of_the_length() -> None:
    solid = mesh_cells(tube()).solid
    assert share_inside(chain(), solid) == 1.0
    assert joints_outside(chain(), solid) == []
    # one bone of 0.6 out of the middle, one of 1.2 across it of which 0.3 are inside
    L = Skeleton(("a", "b", "c"), np.array([-1, 0, 1]), np.array([[0, 0.5, 0], [0, 0.6, 0], [1.2, 0, 0]]))
    across = np.mean(1.2 * np.linspace(0.15, 0.85, 24) < 0.15)
    assert share_inside(L, solid) == pytest.approx((0.6 + 1.2 * across) / 1.8, abs=0.03)
    assert joints_outside(L, solid) == ["c"]


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_a_skeleton_inside_is_taken_as_it_is(unit: float) -> None:
    mesh = tube().with_vertices(unit * tube().vertices)
    skeleton = similar_skeleton(chain(), IDENTITY, unit, np.zeros(3))
    bound = given_skin(mesh, skeleton)
    assert bound.skin.skeleton is skeleton and bound.facts["placed"] == "as it is" and bound.warnings == ()
    assert_allclose(bound.skin.weights.sum(axis=1), 1, atol=1e-12)
    # weights follow the height
    y = mesh.vertices[:, 1] / unit
    assert (bound.skin.weights[y < 0.5, 0] > 0.8).all() and (bound.skin.weights[y > 1.6, 2] > 0.8).all()


def test_weights_below_a_thousandth_are_dropped() -> None:
    weights = bind(tube(), chain()).weights
    assert ((weights == 0) | (weights >= 1e-3)).all() and (weights == 0).any()


@pytest.mark.parametrize("quarter", [0, 1])
def test_a_skeleton_elsewhere_is_moved_and_scaled_into_the_mesh(quarter: int) -> None:
    turn = from_rotation_vector(np.array([0.0, 0.5 * np.pi * quarter, 0.0]))
    away = similar_skeleton(chain(), turn, 0.01, np.array([5.0, -3.0, 1.0]))
    placed = place_skeleton(away, tube())
    assert placed.how == "moved and scaled" and placed.inside == 1.0
    assert "only 0 % of the skeleton's bones lay inside the mesh" in placed.warnings[0]
    P = positions(placed.skeleton)
    assert_allclose(P[:, [0, 2]], 0, atol=0.03)
    # proportions are kept
    lengths = np.diff(P[:, 1])
    assert_allclose(lengths / lengths.sum(), np.array([0.6, 0.7]) / 1.3, atol=1e-9)


def test_a_skeleton_that_fits_nowhere_is_refused_with_the_measure() -> None:
    with pytest.raises(
        ValueError, match=r"lies outside the mesh: \d+ % .* and \d+ % after moving and scaling"
    ):
        given_skin(tube(), star(30.0))


def test_one_that_fits_in_part_is_used_with_a_warning() -> None:
    T = Skeleton(("a", "b", "c"), np.array([-1, 0, 1]), np.array([[0, 0.2, 0], [0, 1.6, 0], [0.7, 0, 0]]))
    bound = given_skin(tube(), T)
    assert any("joints outside: c" in w and "% of the length" in w for w in bound.warnings)


def test_a_skin_of_the_same_vertices_is_taken_as_it_is() -> None:
    skin = human_skin()
    bound = given_skin(skin.mesh, skin)
    assert bound.skin is skin and bound.warnings == ()
    turned = skin.mesh.faces[:, ::-1]
    bound = given_skin(replace(skin.mesh, faces=turned, polygons=None, uv=None, uv_faces=None), skin)
    assert "other faces" in bound.warnings[0]


def test_what_the_reader_did_to_weights_and_what_is_unbound_is_said() -> None:
    skin = human_skin()
    weights = np.array(skin.weights)
    weights[:7] = 0
    noted = replace(
        skin.mesh, source=Source(notes=("weights of 3 vertices summed to 0.5", "a group is empty"))
    )
    said = given_skin(skin.mesh, SkinnedMesh(noted, skin.skeleton, weights)).warnings
    assert said[0].startswith("weights of 3") and "7 of" in said[1] and len(said) == 2


def test_of_a_skin_of_another_mesh_the_skeleton_is_used() -> None:
    skin = SkinnedMesh(tube(rings=30), chain(), np.eye(3)[np.zeros(30 * 12 + 2, dtype=int)])
    bound = given_skin(tube(), skin)
    assert "another mesh (362 vertices, not 290)" in bound.warnings[0]
    assert_allclose(bound.skin.weights, bind(tube(), chain()).weights)


def test_joints_with_a_role_go_where_the_body_has_them() -> None:
    # the true skeleton, turned, scaled, elsewhere, with other rest rotations
    away = similar_skeleton(
        human_skin().skeleton, from_rotation_vector(np.array([0.3, 2.0, -0.4])), 39.0, np.array([9.0, 1, 2])
    )
    roles = find_roles(away)
    posed = posed_like(away, roles, embedded())
    there = positions(embedded().skeleton)
    for role in embedded().skeleton.names:
        assert_allclose(positions(posed)[roles[role]], there[embedded().skeleton.index(role)], atol=1e-9)
    assert posed.names == away.names and share_inside(posed, mesh_cells(human_skin().mesh).solid) > 0.95


def test_a_skeleton_that_is_there_already_stays() -> None:
    there = embedded().skeleton
    posed = posed_like(there, find_roles(there), embedded())
    assert_allclose(positions(posed), positions(there), atol=1e-12)
    assert posed.rest_rotations is not None
    assert angle_between(posed.rest_rotations, np.broadcast_to(IDENTITY, (21, 4))).max() < 1e-6


def test_rest_rotations_turn_with_the_bones() -> None:
    skeleton = human_skin().skeleton
    roles = find_roles(skeleton)
    turn = from_rotation_vector(np.array([0.0, 1.2, 0.0]))
    one = posed_like(skeleton, roles, embedded())
    other = posed_like(similar_skeleton(skeleton, turn, 2.0, np.ones(3)), roles, embedded())
    a, b = rest_transforms(one)[0], rest_transforms(other)[0]
    assert angle_between(a, b).max() < 1e-6
    # and each bone lies in its joint's basis as it did
    arm, hand = skeleton.index("left_forearm"), skeleton.index("left_hand")
    before, after = (s.offsets[hand] / np.linalg.norm(s.offsets[hand]) for s in (skeleton, one))
    assert_allclose(after, before, atol=1e-9)
    assert arm == skeleton.parents[hand]


def test_a_human_skeleton_elsewhere_is_posed_like_the_body() -> None:
    away = similar_skeleton(human_skin().skeleton, IDENTITY, 100.0, np.array([0.0, 500.0, 0.0]))
    rig = fit_rig(human_skin().mesh, away)
    assert rig.report["placed"] == "posed" and rig.report["inside_percent"] > 90
    assert "posed like the body in the mesh" in rig.report["warnings"][0]


def test_weights_are_normalised_and_it_is_said_how_far_off_they_were() -> None:
    weights = np.array([[0.5, 0.5], [0.2, 0.2], [0.0, 0.0], [1.0, 1.0]])
    result, warnings = normalised_weights(weights)
    assert_allclose(result, [[0.5, 0.5], [0.5, 0.5], [0, 0], [0.5, 0.5]])
    assert "2 of 4 vertices" in warnings[0] and "summed to 2, at vertex 3" in warnings[0]
    assert normalised_weights(result)[1] == ()
    with pytest.raises(ValueError, match="weights must be >= 0, got -1 at vertex 0, joint 1"):
        normalised_weights(np.array([[2.0, -1.0]]))


def test_a_saved_rig_and_a_missing_file(tmp_path: Path) -> None:
    rig = random_rig(human_skin(), 2)
    path = rig.save(tmp_path / "ann.tempose")
    skin = read_skeleton(path)
    assert isinstance(skin, SkinnedMesh)
    assert_array_equal(skin.weights, rig.skin.weights)
    with pytest.raises(ValueError, match=r"none\.bvh"):
        read_skeleton(tmp_path / "none.bvh")
    with pytest.raises(FileNotFoundError):
        read_skeleton(tmp_path / "none.tempose")


def test_a_clip_on_its_own_skin_is_followed_exactly(tmp_path: Path) -> None:
    rig = random_rig(human_skin(), 4)
    clip = MeshClip(rig.vertices(), rig.skin.mesh, 25.0)
    for skeleton in (rig.skin, rig, rig.save(tmp_path / "ann.tempose"), str(tmp_path / "ann.tempose")):
        fitted = fit_rig(clip, skeleton)
        assert fitted.report["errors"]["rms_percent"] < 1e-3 and fitted.motion.fps == 25.0
        assert fitted.report["skeleton"] == "given" and "refined" not in fitted.report


def test_refining_finds_joints_that_were_moved() -> None:
    rig = random_rig(human_skin(), 12, 0.5)
    skeleton = rig.skin.skeleton
    offsets = np.array(skeleton.offsets)
    offsets[skeleton.index("left_forearm")] += [0.02, 0.01, 0.0]
    wrong = SkinnedMesh(rig.skin.mesh, replace(skeleton, offsets=offsets), rig.skin.weights)
    clip = MeshClip(rig.vertices(), rig.skin.mesh)
    plain, refined = fit_rig(clip, wrong), fit_rig(clip, wrong, refine=True)
    assert refined.report["errors"]["rms"] < 0.5 * plain.report["errors"]["rms"]
    assert_array_equal(plain.skin.skeleton.offsets, offsets)


def test_boxes_are_turned_about_y() -> None:
    flat = Mesh(tube().vertices * [1.0, 0.2, 1.0], tube().faces)
    rows = Skeleton(("a", "b"), np.array([-1, 0]), np.array([[0.0, 0, 0], [0, 0, 0.2]]))
    placed = place_skeleton(rows, flat)
    assert placed.inside > 0.9
    assert_allclose(rotate(IDENTITY, positions(placed.skeleton)), positions(placed.skeleton))
