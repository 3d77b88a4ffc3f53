"""Other proportions: bones as long as asked for, flesh along them, feet where they were."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from rig_bodies import chain, human_skin, random_rig, tube

from tempose.clips import SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rigging import Rig, change_proportions
from tempose.rigging.proportions import read_factors, stretch_field
from tempose.rigging.proportions.stretch import bone_directions


def hard(skin: SkinnedMesh) -> SkinnedMesh:
    """Every vertex on the joint it follows most."""
    return replace(skin, weights=np.eye(skin.skeleton.n_joints)[skin.weights.argmax(axis=1)])


def tube_rig(frames: int = 4) -> Rig:
    mesh, skeleton = tube(), chain()
    share = np.clip((mesh.vertices[:, 1:2] - [[0.1, 0.7, 1.4]]) / 0.3, 0, 1)
    weights = np.column_stack([1 - share[:, 1], share[:, 1] - share[:, 2], share[:, 2]])
    return random_rig(SkinnedMesh(mesh, skeleton, weights), frames)


def bone_lengths(rig: Rig) -> np.ndarray:
    motion = rig.motion
    P = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)[1]
    return np.linalg.norm(P[:, 1:] - P[:, motion.skeleton.parents[1:]], axis=-1)


def test_factors_of_one_change_nothing() -> None:
    rig = random_rig(human_skin())
    for factors in ({}, {"shin": 1.0}, {"spine": {"length": 1.0, "thickness": 1.0}}):
        same = change_proportions(rig, factors)
        assert_array_equal(same.skin.mesh.vertices, rig.skin.mesh.vertices)
        assert_array_equal(same.skin.skeleton.offsets, rig.skin.skeleton.offsets)
        assert_allclose(same.motion.root_position, rig.motion.root_position, atol=1e-12)
        assert_allclose(same.vertices(), rig.vertices(), atol=1e-12)


def test_bones_are_as_long_as_asked_for_in_every_frame() -> None:
    rig = random_rig(human_skin())
    changed = change_proportions(rig, {"shin": 1.4, "left_forearm": {"length": 0.6, "thickness": 1.5}})
    expected = bone_lengths(rig)
    below = [rig.skin.skeleton.index(n) - 1 for n in ("left_foot", "right_foot")]
    expected[:, below] *= 1.4
    expected[:, rig.skin.skeleton.index("left_hand") - 1] *= 0.6
    assert_allclose(bone_lengths(changed), expected, rtol=1e-12)
    assert_allclose(bone_lengths(changed).std(axis=0), 0, atol=1e-12)


def test_flesh_is_stretched_along_and_across_its_bone() -> None:
    rig = random_rig(hard(human_skin()))
    changed = change_proportions(rig, {"left_shin": {"length": 1.3, "thickness": 0.8}})
    j = rig.skin.skeleton.index("left_shin")
    on = rig.skin.weights[:, j] == 1
    away: list[np.ndarray] = []
    for r in (rig, changed):
        P, axis = rest_transforms(r.skin.skeleton)[1][j], bone_directions(r.skin.skeleton)[j]
        from_joint = r.skin.mesh.vertices[on] - P
        along = from_joint @ axis
        away.append(np.column_stack([along, np.linalg.norm(from_joint - along[:, None] * axis, axis=1)]))
    assert_allclose(away[1], away[0] * [1.3, 0.8], atol=1e-12)


def test_tips_grow_with_their_bones() -> None:
    rig = tube_rig()
    changed = change_proportions(rig, {"part_2": 2.0})
    assert rig.skin.skeleton.tips is not None and changed.skin.skeleton.tips is not None
    assert_allclose(changed.skin.skeleton.tips[2], 2.0 * rig.skin.skeleton.tips[2])
    assert_allclose(np.ptp(changed.skin.mesh.vertices[:, 1]), 2.6, atol=1e-12)


def test_the_stretch_is_monotonous_where_bones_meet() -> None:
    rig = tube_rig()
    changed = change_proportions(rig, {"part_1": 3.0})
    order = np.argsort(rig.skin.mesh.vertices[:, 1], kind="stable")
    y = changed.skin.mesh.vertices[order, 1]
    assert (np.diff(y)[np.diff(rig.skin.mesh.vertices[order, 1]) > 1e-9] > 0).all()


def test_a_uniform_factor_is_a_similarity_of_every_frame() -> None:
    rig, f = random_rig(human_skin()), 1.7
    every = {name: {"length": f, "thickness": f} for name in rig.skin.skeleton.names}
    changed = change_proportions(rig, every)
    left = changed.vertices() - f * rig.vertices()
    assert_allclose(np.ptp(left, axis=1), 0, atol=1e-12)
    # sideways one and the same shift for the whole clip; up, as high above the ground as before
    assert_allclose(np.ptp(left[:, :, [0, 2]], axis=(0, 1)), 0, atol=1e-12)
    assert_allclose(changed.vertices()[..., 1].min(axis=1), rig.vertices()[..., 1].min(axis=1), atol=1e-12)


def test_changes_compose() -> None:
    rig = random_rig(hard(human_skin()))
    first = {"thigh": {"length": 1.2, "thickness": 1.1}, "spine": 0.9}
    second = {"thigh": 0.8, "left_forearm": 1.5}
    both = {"thigh": {"length": 0.96, "thickness": 1.1}, "spine": 0.9, "left_forearm": 1.5}
    there, at_once = change_proportions(change_proportions(rig, first), second), change_proportions(rig, both)
    assert_allclose(there.skin.skeleton.offsets, at_once.skin.skeleton.offsets, atol=1e-12)
    assert_allclose(there.skin.mesh.vertices, at_once.skin.mesh.vertices, atol=1e-12)
    assert_allclose(there.vertices(), at_once.vertices(), atol=1e-11)
    assert len(there.report["proportions"]) == 2


def test_back_again_is_where_it_started() -> None:
    rig = tube_rig()
    back = change_proportions(change_proportions(rig, {"part_1": 1.5}), {"part_1": 1 / 1.5})
    assert_allclose(bone_lengths(back), bone_lengths(rig), rtol=1e-12)
    assert_allclose(back.motion.root_position, rig.motion.root_position, atol=2e-2)


def test_the_lowest_point_stays_on_the_ground_while_legs_grow() -> None:
    rig = random_rig(human_skin(), frames=7)
    changed = change_proportions(rig, {"thigh": 1.3, "shin": 1.2})
    assert_allclose(changed.vertices()[..., 1].min(axis=1), rig.vertices()[..., 1].min(axis=1), atol=1e-12)
    assert_allclose(changed.skin.mesh.vertices[:, 1].min(), rig.skin.mesh.vertices[:, 1].min(), atol=1e-12)
    assert changed.skin.mesh.height > rig.skin.mesh.height + 0.1
    # the way sideways grows as the root is higher
    low = rig.skin.mesh.vertices[:, 1].min()
    ratio = (changed.skin.skeleton.offsets[0, 1] - low) / (rig.skin.skeleton.offsets[0, 1] - low)
    way = [r.motion.root_position[:, [0, 2]] - r.motion.root_position[0, [0, 2]] for r in (rig, changed)]
    assert ratio > 1.1
    assert_allclose(way[1], ratio * way[0], atol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_does_not_matter(unit: float) -> None:
    rig = random_rig(human_skin(), frames=3)
    skeleton = rig.skin.skeleton
    assert skeleton.tips is not None
    scaled_skeleton = replace(skeleton, offsets=unit * skeleton.offsets, tips=unit * skeleton.tips)
    mesh = rig.skin.mesh.with_vertices(unit * rig.skin.mesh.vertices)
    motion = replace(
        rig.motion, skeleton=scaled_skeleton, root_position=unit * np.asarray(rig.motion.root_position)
    )
    scaled = Rig(SkinnedMesh(mesh, scaled_skeleton, rig.skin.weights), motion)
    factors = {"thigh": 1.3, "neck": {"thickness": 0.8}}
    wanted = unit * change_proportions(rig, factors).vertices()
    assert_allclose(change_proportions(scaled, factors).vertices(), wanted, atol=1e-11 * unit)


def test_the_stretch_field_is_the_derivative_of_the_flesh() -> None:
    rig, factors = tube_rig(), {"part_1": {"length": 1.4, "thickness": 0.7}}
    field = stretch_field(rig.skin, read_factors(rig.skin.skeleton, factors))
    V = rig.skin.mesh.vertices
    changed = change_proportions(rig, factors).skin.mesh.vertices
    # where weights are constant, between the vertices of one ring: across the bone
    ring = slice(12 * 9, 12 * 10)
    assert_allclose(
        changed[ring] - changed[ring][:1],
        np.einsum("nab,nb->na", field[ring], V[ring] - V[ring][:1]),
        atol=1e-12,
    )
    one = stretch_field(rig.skin, read_factors(rig.skin.skeleton, {}))
    assert_allclose(one, np.broadcast_to(np.eye(3), one.shape), atol=1e-12)


def test_the_middle_child_gives_the_direction() -> None:
    skeleton = human_skin().skeleton
    P, ways = rest_transforms(skeleton)[1], bone_directions(skeleton)
    for joint, child in (("hips", "spine"), ("chest", "neck"), ("left_thigh", "left_shin")):
        way = P[skeleton.index(child)] - P[skeleton.index(joint)]
        assert_allclose(ways[skeleton.index(joint)], way / np.linalg.norm(way), atol=1e-12)


@pytest.mark.parametrize(
    ("factors", "message"),
    [
        ({"left_shinn": 1.2}, "the skeleton has left_shin"),
        ({"left_shin": -1}, "must be a positive number, got -1"),
        ({"left_shin": float("nan")}, "must be a positive number, got nan"),
        ({"left_shin": True}, "must be a positive number, got True"),
        ({"left_shin": {"width": 1.0}}, "unknown key 'width'; known are length, thickness"),
        ({"left_shin": 1.1, "shin": 1.2}, "'left_shin' twice"),
    ],
)
def test_wrong_factors_are_refused(factors: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        change_proportions(random_rig(human_skin(), 2), factors)
