"""Pairs out of skin weights, and joints out of fields."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import human_body, t_pose
from transfer_zoo import tube

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics import rest_transforms
from tempose.samples.skeletons import animal_skeleton, human_skeleton
from tempose.transfer import MotionTransfer, pairs_from_skin
from tempose.transfer.pairing.marks import owned_faces
from tempose.transfer.pairing.skin_pairs import estimate_joints

SPOKEN = {
    "hips": "pelvis", "spine": "spine_01", "chest": "spine_02", "neck": "neck_01", "head": "head",
    "clavicle": "clavicle", "upper_arm": "upperarm", "forearm": "lowerarm", "hand": "hand",
    "thigh": "thigh", "shin": "calf", "foot": "foot", "toes": "ball",
}  # fmt: skip


def renamed(skeleton: Skeleton, names: list[str]) -> Skeleton:
    return Skeleton(tuple(names), skeleton.parents, skeleton.offsets, skeleton.rest_rotations, skeleton.tips)


def unreal(skeleton: Skeleton) -> Skeleton:
    """The human by the names of another maker: left_forearm becomes lowerarm_l."""
    names = []
    for name in skeleton.names:
        side, _, part = name.partition("_") if name.startswith(("left_", "right_")) else ("", "", name)
        names.append(SPOKEN[part] + (f"_{side[0]}" if side else ""))
    return renamed(skeleton, names)


def test_skeletons_that_share_their_names_are_matched_by_name() -> None:
    body = human_body()
    pairs = pairs_from_skin(body.skeleton, body)
    assert pairs.kind == "joints" and pairs.origin == "the target's skin weights"
    P = rest_transforms(body.skeleton)[1]
    for name, place in pairs.joints.items():
        assert_allclose(place, P[body.skeleton.index(name)], atol=1e-12)
    for bone, following in (("left_thigh", "left_shin"), ("right_forearm", "right_hand"), ("neck", "head")):
        assert_allclose(pairs.ends[bone], P[body.skeleton.index(following)], atol=1e-12)
    owner = owned_faces(body.mesh.faces, body.weights)
    assert [body.skeleton.names[o] for o in owner[pairs.target]] == list(pairs.source)


def test_skeletons_of_other_makers_are_matched_by_role() -> None:
    body = human_body()
    plain = pairs_from_skin(body.skeleton, body)
    other = replace(body, skeleton=unreal(body.skeleton))
    pairs = pairs_from_skin(body.skeleton, other)
    assert set(pairs.source) == set(plain.source)
    by_role = {name: set(pairs.target[np.array(pairs.source) == name]) for name in set(pairs.source)}
    for name in by_role:
        assert by_role[name] == set(plain.target[np.array(plain.source) == name])
        assert_allclose(pairs.joints[name], plain.joints[name], atol=1e-12)
        assert_allclose(pairs.ends[name], plain.ends[name], atol=1e-12)


def test_a_mapping_says_what_names_do_not() -> None:
    body = human_body()
    nameless = renamed(t_pose(), [f"joint{j}" for j in range(body.skeleton.n_joints)])
    with pytest.raises(ValueError, match=r"no joints of the source .* give pairs, or a mapping"):
        pairs_from_skin(nameless, body)
    mapping = {f"joint{body.skeleton.index(r)}": r for r in ("hips", "chest", "left_thigh", "left_shin")}
    pairs = pairs_from_skin(nameless, body, mapping)
    assert set(pairs.source) == set(mapping)
    with pytest.raises(ValueError, match="roles are"):
        pairs_from_skin(nameless, body, {"joint3": "elbow"})


def test_joints_the_source_lacks_move_with_the_one_above() -> None:
    """Hands and feet without a partner are marked with what carries them."""
    body = human_body()
    full = body.skeleton
    keep = [j for j, name in enumerate(full.names) if not name.endswith(("hand", "toes"))]
    index = {j: k for k, j in enumerate(keep)}
    parents = np.array([index.get(int(full.parents[j]), -1) for j in keep])
    fewer = Skeleton(tuple(full.names[j] for j in keep), parents, full.offsets[keep])
    pairs = pairs_from_skin(fewer, body)
    assert set(pairs.source) <= set(fewer.names)
    weights = np.array(body.weights)
    for side in ("left_", "right_"):
        hand, arm = full.index(side + "hand"), full.index(side + "forearm")
        weights[:, arm] += weights[:, hand]
        toes, foot = full.index(side + "toes"), full.index(side + "foot")
        weights[:, foot] += weights[:, toes]
    owner = owned_faces(body.mesh.faces, weights[:, keep])
    feet = pairs.target[np.array(pairs.source) == "left_foot"]
    assert_array_equal(np.sort(feet), np.flatnonzero(owner == fewer.index("left_foot")))


def test_a_human_and_a_pony_have_nothing_in_common() -> None:
    with pytest.raises(ValueError, match="correspond"):
        pairs_from_skin(renamed(animal_skeleton(), [f"bone_{k}" for k in range(32)]), human_body())


def test_rings_go_where_they_are_asked() -> None:
    body = human_body()
    wide = pairs_from_skin(body.skeleton, body, ring_places=(0.1, 0.9))
    tight = pairs_from_skin(body.skeleton, body, ring_places=(0.45, 0.55))
    start, end = wide.joints["left_shin"], wide.ends["left_shin"]
    spread = []
    for pairs in (wide, tight):
        faces = body.mesh.faces[pairs.target[np.array(pairs.source) == "left_shin"]]
        along = (
            (body.mesh.vertices[faces].mean(axis=1) - start) @ (end - start) / ((end - start) @ (end - start))
        )
        spread.append(np.ptp(along))
    assert spread[0] > 0.6 > 0.3 > spread[1]


def test_joints_are_found_where_the_fields_of_neighbours_meet() -> None:
    """Three segments of a tube, marked in the middle of each: joints a third and two thirds up."""
    mesh = tube(61, 24, 3.0, 0.15)
    V = mesh.vertices
    marks = [np.flatnonzero(np.abs(V[:, 1] - y) < 0.06) for y in (0.5, 1.5, 2.5)]
    solver = MotionTransfer(mesh, np.concatenate(marks), np.repeat([0, 1, 2], [len(m) for m in marks]), 3)
    starts, ends = estimate_joints(V, solver.basis, np.array([-1, 0, 1]))
    assert_allclose(starts[1], [0, 1.0, 0], atol=0.02)
    assert_allclose(starts[2], [0, 2.0, 0], atol=0.02)
    assert_allclose(ends[0], starts[1], atol=1e-12)
    assert_allclose(ends[1], starts[2], atol=1e-12)
    # the last bone ends as far beyond the middle of its field as it began before it
    assert_allclose(ends[2] - [0, 2.5, 0], [0, 2.5, 0] - starts[2], atol=0.4)
    assert ends[2][1] > 2.8


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_estimated_joints_move_with_the_mesh(unit: float) -> None:
    mesh = tube(31, 12, 3.0, 0.15)
    marks = np.r_[0:24, 29 * 12 : 31 * 12]
    columns = np.repeat([0, 1], 24)
    basis = MotionTransfer(mesh, marks, columns, 2).basis
    moved = unit * (mesh.vertices + np.array([1.0, 2, 3]))
    for a, b in zip(estimate_joints(moved, basis, [-1, 0]), estimate_joints(mesh.vertices, basis, [-1, 0])):
        assert_allclose(a, unit * (b + np.array([1.0, 2, 3])), rtol=0, atol=1e-9 * unit)


def test_a_fork_ends_where_its_branches_begin() -> None:
    mesh = tube(31, 12, 3.0, 0.15)
    basis = np.abs(np.random.default_rng(0).normal(size=(len(mesh.vertices), 4)))
    parents = np.array([-1, 0, 1, 1])
    starts, ends = estimate_joints(mesh.vertices, basis / basis.sum(axis=1, keepdims=True), parents)
    assert_allclose(ends[1], (starts[2] + starts[3]) / 2, atol=1e-12)
    assert_allclose(ends[0], starts[1], atol=1e-12)


def test_weights_of_zero_belong_to_nobody() -> None:
    body = human_body()
    weights = np.array(body.weights)
    weights[::50] = 0
    loose = SkinnedMesh(Mesh(body.mesh.vertices, body.mesh.faces), body.skeleton, weights)
    pairs = pairs_from_skin(body.skeleton, loose)
    assert len(np.unique(pairs.target)) == len(pairs)


def test_rest_poses_need_not_be_alike() -> None:
    body = human_body()
    a, b = pairs_from_skin(t_pose(), body), pairs_from_skin(human_skeleton(), body)
    assert_array_equal(a.target, b.target)
    assert a.source == b.source
