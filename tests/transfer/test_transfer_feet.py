"""Feet: whose they are, when they stand."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import about, clip_of, human_body, scaled, turned
from transfer_zoo import sphere

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics.roles import find_roles
from tempose.metrics import detect_contacts
from tempose.samples.skeletons import animal_skeleton, human_skeleton
from tempose.samples.walk import walk
from tempose.transfer.bodies.bones import Bones, make_bones
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.feet import bone_feet, flat_stance
from tempose.transfer.feet.mesh_feet import mesh_feet
from tempose.transfer.turns.reference import bone_motion, bone_rest


def bones_and_motion(
    clip: SkeletonClip, names: tuple[str, ...] | None = None
) -> tuple[Bones, BonePose, BonePose]:
    roles = find_roles(clip.skeleton)
    bones = make_bones(clip.skeleton, names or clip.skeleton.names, roles)
    return bones, bone_motion(clip, bones, roles), bone_rest(clip, bones, roles)


def owner_of(bones: Bones, skeleton: Skeleton) -> np.ndarray:
    body = human_body()
    column = {name: b for b, name in enumerate(bones.names)}
    names = [skeleton.names[j] for j in body.weights.argmax(axis=1)]
    return np.array([column.get(name, 0) for name in names])


def test_feet_of_a_human_are_the_balls_of_its_feet() -> None:
    clip = walk(human_skeleton(), duration=2.0, fps=60.0)
    bones, motion, rest = bones_and_motion(clip)
    owner = owner_of(bones, clip.skeleton)
    feet = bone_feet(bones, motion, rest, owner, 1.75, clip.fps)
    assert feet.names == ("left_foot", "right_foot")
    left = [bones.find("left_foot"), bones.find("left_toes")]
    assert_array_equal(feet.vertices[0], np.flatnonzero(np.isin(owner, left)))
    assert_allclose(feet.trajectories[:, 0], motion.starts[:, left[1]])
    assert_array_equal(feet.contact, detect_contacts(feet.trajectories, 1.75, clip.fps))


def test_contacts_are_found_where_the_walk_planted_them() -> None:
    clip = walk(human_skeleton(), duration=4.0, fps=60.0)
    bones, motion, rest = bones_and_motion(clip)
    feet = bone_feet(bones, motion, rest, owner_of(bones, clip.skeleton), 1.75, clip.fps)
    balls = [[s.name for s in clip.soles].index(f"{side}_foot_ball") for side in ("left", "right")]
    truth = clip.contacts[:, balls]
    # a ball that stands is found, but for the frames next to landing and lifting
    inner = np.stack([np.roll(truth, k, axis=0) for k in range(-3, 4)]).all(axis=0)
    assert feet.contact[inner][5:-5].all()
    assert (feet.contact == truth).mean() > 0.85


def test_feet_without_toes_end_at_the_end_of_the_foot() -> None:
    full = human_skeleton()
    names = tuple(n for n in full.names if not n.endswith("toes"))
    clip = clip_of(full, {"left_foot": about("x", 20)}, 4)
    bones, motion, rest = bones_and_motion(clip, names)
    feet = bone_feet(bones, motion, rest, owner_of(bones, full), 1.75, 30.0)
    assert_allclose(feet.trajectories[:, 1], motion.ends[:, bones.names.index("right_foot")])


def test_a_foot_without_vertices_is_none() -> None:
    clip = clip_of(human_skeleton(), {}, 2)
    bones, motion, rest = bones_and_motion(clip)
    left = [bones.find("left_foot"), bones.find("left_toes")]
    feet = bone_feet(bones, motion, rest, np.repeat(left, 2), 1.75, 30.0)
    assert feet.names == ("left_foot",)
    nothing = bone_feet(bones, motion, rest, np.zeros(9, int), 1.75, 30.0)
    assert nothing.names == () and nothing.trajectories.shape == (2, 0, 3) and nothing.contact.shape == (2, 0)


def test_hooves_are_the_leaves_that_reach_the_ground() -> None:
    skeleton = animal_skeleton()
    clip = clip_of(skeleton, {}, 3)
    bones, motion, rest = bones_and_motion(clip)
    owner = np.arange(len(bones.names))
    feet = bone_feet(bones, motion, rest, owner, 1.45, 30.0)
    assert set(feet.names) == {n for n in skeleton.names if n.endswith("hoof")}
    assert feet.contact.all()


def test_soles_are_flat_when_ankle_and_ball_rest() -> None:
    clip = walk(human_skeleton(), duration=4.0, fps=60.0)
    bones, motion, _ = bones_and_motion(clip)
    flat = flat_stance(bones, motion, 1.75, clip.fps)
    left, toes = bones.find("left_foot"), bones.find("left_toes")
    assert_array_equal(flat[:, left], flat[:, toes])
    others = [b for b in range(len(bones.names)) if not bones.roles[b].endswith(("foot", "toes"))]
    assert not flat[:, others].any()
    # while flat, the slope of the foot hardly changes: it neither lands nor rolls off
    assert flat[:, left].sum() > 20
    slope = np.degrees(np.arcsin(motion.directions[flat[:, left], left, 1]))
    assert np.ptp(slope) < 12
    assert np.ptp(np.degrees(np.arcsin(motion.directions[:, left, 1]))) > 40


def test_flat_stance_does_not_care_for_place_facing_and_unit() -> None:
    clip = walk(human_skeleton(), duration=2.0, fps=60.0)
    bones, motion, _ = bones_and_motion(clip)
    expected = flat_stance(bones, motion, 1.75, clip.fps)
    _, other, _ = bones_and_motion(turned(scaled(clip, 100.0), about("y", 77)))
    assert_array_equal(flat_stance(bones, other, 175.0, clip.fps), expected)


def test_a_single_frame_stands() -> None:
    bones, motion, _ = bones_and_motion(clip_of(human_skeleton(), {}, 1))
    assert flat_stance(bones, motion, 1.75, 30.0)[0, bones.find("right_foot")]


def test_feet_of_meshes_are_clusters_of_low_pairs() -> None:
    ball = sphere()
    V_rest = np.array(ball.vertices)
    low = np.argsort(V_rest[:, 1])
    feet_of = np.r_[low[:1], low[-1:]]
    frames = np.stack([V_rest, V_rest + np.array([0, 0.1, 0])])
    feet = mesh_feet(frames, V_rest, feet_of, V_rest, ball.faces, feet_of, 30.0)
    assert feet.names == ("foot 1",)
    assert_allclose(feet.trajectories[:, 0], frames[:, low[0]])
    assert low[0] in feet.vertices[0]
    none = mesh_feet(frames, V_rest, low[-2:], V_rest, ball.faces, low[-2:], 30.0)
    assert none.names == () and none.contact.shape == (2, 0)


def test_two_legs_of_a_mesh_are_two_feet() -> None:
    body = human_body().mesh
    V = np.array(body.vertices)
    left = np.flatnonzero((V[:, 1] < 0.04) & (V[:, 0] > 0))[::2]
    right = np.flatnonzero((V[:, 1] < 0.04) & (V[:, 0] < 0))[::2]
    pairs = np.r_[left, right, np.argsort(-V[:, 1])[:5]]
    feet = mesh_feet(V[None], V, pairs, 2 * V, body.faces, pairs, 30.0)
    assert len(feet.names) == 2
    sides = sorted(np.sign(V[mine, 0].mean()) for mine in feet.vertices)
    assert sides == [-1, 1]
    assert max(V[mine, 1].max() for mine in feet.vertices) < 0.2
