"""Bones: which joints, which tree, where each begins and ends."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import clip_of, t_pose, world_of
from transfer_zoo import wxyz

from tempose.clips import Skeleton
from tempose.kinematics.roles import find_roles
from tempose.rotations import rotate
from tempose.samples.skeletons import human_skeleton
from tempose.transfer.bodies.bones import bone_spans, make_bones, split_role
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.turns.reference import bone_motion, bone_rest


@pytest.mark.parametrize(
    ("role", "parts"),
    [
        ("left_forearm", ("left_", "forearm")),
        ("right_toes", ("right_", "toes")),
        ("chest", ("", "chest")),
        ("", ("", "")),
    ],
)
def test_roles_split_into_side_and_part(role: str, parts: tuple[str, str]) -> None:
    assert split_role(role) == parts


def test_the_tree_skips_joints_that_move_nothing() -> None:
    skeleton = human_skeleton()
    names = ("left_hand", "hips", "head", "left_upper_arm", "chest", "right_shin")
    bones = make_bones(skeleton, names, find_roles(skeleton))
    # in the order of the skeleton, each hanging on the nearest of the chosen above it
    assert bones.names == ("hips", "chest", "head", "left_upper_arm", "left_hand", "right_shin")
    assert [bones.names[p] if p >= 0 else "" for p in bones.parents] == [
        "", "hips", "chest", "chest", "left_upper_arm", "hips",
    ]  # fmt: skip
    assert (bones.parents < np.arange(6)).all()
    assert bones.roles == bones.names
    assert bones.find("chest") == 1 and bones.find("neck") is None
    assert_array_equal(bones.joints, [skeleton.index(n) for n in bones.names])


def test_bones_without_the_root_are_several_trees() -> None:
    skeleton = human_skeleton()
    bones = make_bones(skeleton, ("left_thigh", "left_shin", "head"), {})
    assert bones.names == ("head", "left_thigh", "left_shin")
    assert_array_equal(bones.parents, [-1, -1, 1])
    assert bones.roles == ("", "", "")


def test_bones_end_at_the_joint_of_the_next_part(rng) -> None:
    skeleton = human_skeleton()
    roles = find_roles(skeleton)
    joints = np.arange(skeleton.n_joints)
    q = wxyz(Rotation.random(2 * skeleton.n_joints, rng=rng)).reshape(2, -1, 4)
    root = rng.normal(size=(2, 3))
    turns, starts, ends = bone_spans(skeleton, joints, roles, q, root)
    clip = clip_of(skeleton, {}, 2)
    world, P = world_of(type(clip)(skeleton, q, root))
    assert_allclose(turns, world, rtol=0, atol=1e-12)
    assert_allclose(starts, P, rtol=0, atol=1e-12)
    for start, end in (
        ("hips", "spine"),
        ("spine", "chest"),
        ("chest", "neck"),
        ("neck", "head"),
        ("left_clavicle", "left_upper_arm"),
        ("left_upper_arm", "left_forearm"),
        ("right_forearm", "right_hand"),
        ("left_thigh", "left_shin"),
        ("right_shin", "right_foot"),
        ("left_foot", "left_toes"),
    ):
        b, e = skeleton.index(start), skeleton.index(end)
        assert_allclose(ends[:, b], P[:, e], rtol=0, atol=1e-12, err_msg=start)
    # leaves end at their tips
    for leaf in ("head", "left_hand", "right_toes"):
        j = skeleton.index(leaf)
        assert_allclose(ends[:, j], P[:, j] + rotate(world[:, j], skeleton.tips[j]), rtol=0, atol=1e-12)


def test_the_length_of_a_bone_never_changes(rng) -> None:
    skeleton = human_skeleton()
    bones = make_bones(skeleton, skeleton.names, find_roles(skeleton))
    q = wxyz(Rotation.random(30 * skeleton.n_joints, rng=rng)).reshape(30, -1, 4)
    clip = clip_of(skeleton, {}, 30)
    motion = bone_motion(type(clip)(skeleton, q, rng.normal(size=(30, 3))), bones, find_roles(skeleton))
    assert_allclose(motion.lengths, np.broadcast_to(motion.lengths[0], motion.lengths.shape), atol=1e-12)
    assert_allclose(np.linalg.norm(motion.directions, axis=-1), 1, atol=1e-12)


def cmu_like() -> Skeleton:
    """Hips with children of no length, two at one place, and fingers: as the converted CMU files have."""
    joints = [
        ("Hips", "", (0, 1, 0)),
        ("LHipJoint", "Hips", (0, 1, 0)),
        ("LeftUpLeg", "LHipJoint", (0.1, 0.95, 0)),
        ("LeftLeg", "LeftUpLeg", (0.1, 0.5, 0)),
        ("LeftFoot", "LeftLeg", (0.1, 0.1, 0)),
        ("LeftToeBase", "LeftFoot", (0.1, 0.02, 0.12)),
        ("RHipJoint", "Hips", (0, 1, 0)),
        ("RightUpLeg", "RHipJoint", (-0.1, 0.95, 0)),
        ("RightLeg", "RightUpLeg", (-0.1, 0.5, 0)),
        ("RightFoot", "RightLeg", (-0.1, 0.1, 0)),
        ("RightToeBase", "RightFoot", (-0.1, 0.02, 0.12)),
        ("LowerBack", "Hips", (0, 1, 0)),
        ("Spine", "LowerBack", (0, 1.15, 0)),
        ("Spine1", "Spine", (0, 1.3, 0)),
        ("LeftShoulder", "Spine1", (0, 1.3, 0)),
        ("LeftArm", "LeftShoulder", (0.2, 1.4, 0)),
        ("LeftForeArm", "LeftArm", (0.5, 1.4, 0)),
        ("LeftHand", "LeftForeArm", (0.75, 1.4, 0)),
        ("LThumb", "LeftHand", (0.75, 1.4, 0)),
        ("LeftFingerBase", "LeftHand", (0.82, 1.4, 0)),
        ("LeftHandIndex1", "LeftFingerBase", (0.86, 1.4, 0)),
        ("RightShoulder", "Spine1", (0, 1.3, 0)),
        ("RightArm", "RightShoulder", (-0.2, 1.4, 0)),
        ("RightForeArm", "RightArm", (-0.5, 1.4, 0)),
        ("RightHand", "RightForeArm", (-0.75, 1.4, 0)),
        ("Neck", "Spine1", (0, 1.3, 0)),
        ("Neck1", "Neck", (0, 1.45, 0)),
        ("Head", "Neck1", (0, 1.55, 0)),
    ]
    names = tuple(n for n, _, _ in joints)
    parents = np.array([names.index(p) if p else -1 for _, p, _ in joints])
    P = np.array([p for _, _, p in joints], float)
    return Skeleton(names, parents, np.where(parents[:, None] < 0, P, P - P[parents]))


def test_children_of_no_length_are_stepped_over() -> None:
    skeleton = cmu_like()
    roles = find_roles(skeleton)
    bones = make_bones(skeleton, skeleton.names, roles)
    rest = bone_rest(clip_of(skeleton, {}, 1), bones, roles)
    P = dict(zip(skeleton.names, rest.starts))
    for start, end in (
        ("LeftArm", "LeftForeArm"),
        ("LeftForeArm", "LeftHand"),
        ("LeftHand", "LeftHandIndex1"),
        ("LeftUpLeg", "LeftLeg"),
        ("RightFoot", "RightToeBase"),
    ):
        assert_allclose(rest.ends[bones.names.index(start)], P[end], atol=1e-12, err_msg=start)
    hips = rest.directions[bones.names.index("Hips")]
    assert_allclose(hips, [0, 1, 0], atol=1e-12)
    # a leaf without a tip has no direction, and says so by zeros
    leaf = bones.names.index("LThumb")
    assert_array_equal(rest.directions[leaf], 0)


def test_a_pose_is_a_frame_of_a_motion(rng) -> None:
    motion = BonePose(rng.normal(size=(5, 3, 4)), rng.normal(size=(5, 3, 3)), rng.normal(size=(5, 3, 3)))
    one = motion.frame(2)
    assert_array_equal(one.starts, motion.starts[2])
    assert_array_equal(one.directions, motion.directions[2])
    still = BonePose(motion.turns, motion.starts, motion.starts)
    assert_array_equal(still.directions, 0)
    assert_array_equal(still.lengths, 0)


def test_the_t_pose_of_these_tests_is_one() -> None:
    skeleton = t_pose()
    roles = find_roles(skeleton)
    bones = make_bones(skeleton, skeleton.names, roles)
    rest = bone_rest(clip_of(skeleton, {}, 1), bones, roles)
    expected = {"left_forearm": [1, 0, 0], "right_upper_arm": [-1, 0, 0], "left_shin": [0, -1, 0]}
    for name, along in expected.items():
        assert_allclose(rest.directions[bones.names.index(name)], along, atol=1e-12)
    other = bone_rest(clip_of(human_skeleton(), {}, 1), bones, roles)
    feet = [bones.names.index(side + "shin") for side in ("left_", "right_")]
    assert_allclose(rest.lengths[feet], other.lengths[feet], atol=1e-12)
