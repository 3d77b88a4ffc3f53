"""Which pose of a source is taken as its reference."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, rolled, t_pose, turned
from transfer_zoo import near_rotations, wxyz

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics import forward_kinematics
from tempose.kinematics.roles import find_roles
from tempose.rotations import conjugate, multiply, rotate
from tempose.samples.skeletons import human_skeleton
from tempose.samples.walk import walk
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.turns.alignment import stands_upright
from tempose.transfer.turns.reference import bone_motion, bone_rest, choose_reference

SKELETON = human_skeleton()
ROLES = find_roles(SKELETON)
BONES = make_bones(SKELETON, SKELETON.names, ROLES)


def target() -> BonePose:
    return bone_rest(clip_of(SKELETON, {}, 1), BONES, ROLES)


def walk_like(skeleton: Skeleton, T: int = 20, step: float = 3.0) -> SkeletonClip:
    """Legs and arms that swing by a few degrees a frame."""
    swing = np.radians(30) * np.sin(np.arange(T) * step / 30)[:, None] * [1.0, 0, 0]
    forward, back = wxyz(Rotation.from_rotvec(swing)), wxyz(Rotation.from_rotvec(-swing))
    turns = {
        "left_thigh": forward,
        "right_thigh": back,
        "left_upper_arm": multiply(back, about("z", -40)),
        "right_upper_arm": multiply(forward, about("z", 40)),
    }
    return clip_of(skeleton, turns, T)


def with_first(clip: SkeletonClip, rotations: np.ndarray) -> SkeletonClip:
    q = np.concatenate([rotations[None], clip.rotations])
    return SkeletonClip(
        clip.skeleton, q, np.concatenate([clip.root_position[:1], clip.root_position]), clip.fps
    )


def senseless(clip: SkeletonClip) -> SkeletonClip:
    """The same motion of a skeleton whose rest pose is a crumpled heap: every bone along its own +X."""
    s = clip.skeleton
    world, P = forward_kinematics(s, clip.rotations, clip.root_position)
    J, parents = s.n_joints, np.asarray(s.parents)
    lengths = np.linalg.norm(s.offsets, axis=1)
    # G turns +X of a joint's new basis along the bone towards its first child, or its tip
    G = np.tile([1.0, 0, 0, 0], (J, 1))
    for j in range(J):
        children = s.children(j)
        along = s.offsets[children[0]] if len(children) else s.tips[j]
        if np.linalg.norm(along) > 1e-9 and np.isfinite(along).all():
            G[j] = wxyz(Rotation.align_vectors([along], [[1.0, 0, 0]])[0])
    new_world = multiply(world, G)
    above = np.where(parents < 0, 0, parents)
    local = multiply(conjugate(new_world[:, above]), new_world)
    local[:, 0] = new_world[:, 0]
    offsets = np.where(parents[:, None] < 0, s.offsets, rotate(conjugate(G[above]), s.offsets))
    tips = rotate(conjugate(G), np.nan_to_num(s.tips)) + np.where(np.isnan(s.tips), np.nan, 0)
    made = SkeletonClip(Skeleton(s.names, parents, offsets, tips=tips), local, clip.root_position, clip.fps)
    after = forward_kinematics(made.skeleton, made.rotations, made.root_position)[1]
    assert_allclose(after, P, atol=1e-9 * lengths.max())
    return made


def test_the_rest_pose_serves_where_a_body_can_stand_so() -> None:
    clip = walk_like(t_pose())
    found = choose_reference(clip, BONES, ROLES, target())
    assert found.chosen == "rest pose of the skeleton"
    assert found.upright and found.first_frame == 0 and found.warnings == ()
    rest = bone_rest(clip, BONES, ROLES)
    assert_allclose(found.pose.starts, rest.starts)
    assert_allclose(found.pose.turns, rest.turns)


def test_a_t_pose_before_the_motion_is_taken_and_dropped() -> None:
    skeleton = t_pose()
    clip = with_first(walk_like(skeleton), np.asarray(skeleton.rest_rotations))
    found = choose_reference(clip, BONES, ROLES, target())
    assert found.first_frame == 1
    assert found.chosen.startswith("frame 0")
    assert_allclose(found.pose.turns, bone_motion(clip, BONES, ROLES).turns[0])


def test_a_t_pose_before_the_motion_is_seen_from_any_side_and_with_any_axes(rng) -> None:
    skeleton = t_pose()
    clip = with_first(walk_like(skeleton), np.asarray(skeleton.rest_rotations))
    for other in (turned(clip, about("y", 200)), rolled(clip, rng), senseless(clip)):
        bones = make_bones(other.skeleton, other.skeleton.names, ROLES)
        assert choose_reference(other, bones, ROLES, target()).first_frame == 1


def test_frame_0_of_a_plain_motion_is_motion() -> None:
    """A smooth clip, a fast one, one that starts lying down, and clips too short to tell."""
    skeleton = t_pose()
    plain = walk_like(skeleton)
    fast = walk_like(skeleton, step=40)
    lying = with_first(plain, clip_of(skeleton, {"hips": about("x", 90)}, 1).rotations[0])
    short = plain.frames(slice(0, 2))
    for clip in (plain, fast, lying, short, plain.frames(slice(0, 1))):
        assert choose_reference(clip, BONES, ROLES, target()).first_frame == 0


def test_of_a_meaningless_rest_the_nearest_frame_is_taken() -> None:
    """Bandai's skeletons: zero channels are no pose at all, only a frame can be the reference."""
    clip = senseless(walk_like(SKELETON))
    bones = make_bones(clip.skeleton, clip.skeleton.names, ROLES)
    rest = bone_rest(clip, bones, ROLES)
    assert not stands_upright(bones, rest)
    found = choose_reference(clip, bones, ROLES, target())
    assert not found.upright
    motion = bone_motion(clip, bones, ROLES)
    there = target().directions
    # by a plain sum of angles, frame by frame; this body faces +Z throughout
    angles = [np.arccos(np.clip(np.sum(d * there, axis=1), -1, 1)).sum() for d in motion.directions]
    assert found.chosen == f"frame {int(np.argmin(angles))}, whose bones come nearest to the target's rest"
    assert_allclose(found.pose.starts, motion.starts[int(np.argmin(angles))])


def test_the_chosen_frame_does_not_depend_on_where_the_motion_faces() -> None:
    clip = senseless(walk_like(SKELETON))
    bones = make_bones(clip.skeleton, clip.skeleton.names, ROLES)
    a = choose_reference(clip, bones, ROLES, target())
    b = choose_reference(turned(clip, about("y", 140)), bones, ROLES, target())
    assert a.chosen == b.chosen


@pytest.mark.parametrize("frame", [0, 7, 19])
def test_a_frame_the_user_names_wins(frame: int) -> None:
    clip = walk_like(t_pose())
    found = choose_reference(clip, BONES, ROLES, target(), frame)
    assert found.chosen == f"frame {frame}" and found.first_frame == 0
    assert_allclose(found.pose.turns, bone_motion(clip, BONES, ROLES).turns[frame])


@pytest.mark.parametrize("frame", [-1, 20, 10**9])
def test_a_frame_that_does_not_exist_is_refused(frame: int) -> None:
    with pytest.raises(ValueError, match=rf"source_rest must be a frame from 0 to 19, got {frame}"):
        choose_reference(walk_like(t_pose()), BONES, ROLES, target(), frame)


def test_a_leg_far_from_the_target_is_doubted_by_name() -> None:
    clip = clip_of(SKELETON, {"left_thigh": about("x", -60), "left_shin": about("x", 50)}, 3)
    (warning,) = choose_reference(clip, BONES, ROLES, target(), 1).warnings
    assert "left_thigh differs by 60 degrees" in warning and "source_rest" in warning
    arm = clip_of(SKELETON, {"left_upper_arm": about("z", 80)}, 3)
    assert choose_reference(arm, BONES, ROLES, target(), 1).warnings == ()
    stride = clip_of(SKELETON, {"left_thigh": about("x", -30)}, 3)
    assert choose_reference(stride, BONES, ROLES, target(), 1).warnings == ()


def test_the_bones_of_a_motion_are_forward_kinematics(rng) -> None:
    q = near_rotations(rng, (4, SKELETON.n_joints))
    clip = SkeletonClip(SKELETON, q, rng.normal(size=(4, 3)))
    motion = bone_motion(clip, BONES, ROLES)
    world, P = forward_kinematics(SKELETON, clip.rotations, clip.root_position)
    assert_allclose(motion.turns, world, atol=1e-12)
    assert_allclose(motion.starts, P, atol=1e-12)


@pytest.mark.parametrize("fps", [120.0, 15.0, 10.0])
def test_a_t_pose_before_the_motion_is_seen_however_few_frames_are_kept(fps: float) -> None:
    """Between frames that were thinned out a swinging arm turns a lot, but not all bones at once."""
    walking = walk(t_pose(), duration=4.0, fps=fps)
    roles = find_roles(walking.skeleton)
    bones = make_bones(walking.skeleton, walking.skeleton.names, roles)
    rest = bone_rest(walking, bones, roles)
    put_before = with_first(walking, walking.skeleton.rest_rotations)
    assert choose_reference(walking, bones, roles, rest).first_frame == 0
    assert choose_reference(put_before, bones, roles, rest).first_frame == 1
