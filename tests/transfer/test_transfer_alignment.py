"""The common reference pose: after it the target's bones point where the source's do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, rolled, scaled, t_pose, turned
from transfer_zoo import as_rotation, near_rotations, wxyz

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics.roles import find_roles
from tempose.rotations import angle_between, conjugate, multiply, rotate
from tempose.samples.skeletons import human_skeleton
from tempose.transfer.bodies.bones import Bones, make_bones
from tempose.transfer.bodies.facing import UP, heading, yaw
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.turns.alignment import align_reference, limb_angles, stands_upright
from tempose.transfer.turns.reference import bone_motion, bone_rest

LIMBS = [s + p for s in ("left_", "right_") for p in ("upper_arm", "forearm", "hand", "thigh", "shin")]
FEET = [s + p for s in ("left_", "right_") for p in ("foot", "toes")]
TRUNK = ["hips", "spine", "chest", "neck", "head", "left_clavicle", "right_clavicle"]


@dataclass
class Aligned:
    """A source laid on a target."""

    bones: Bones
    motion: BonePose
    reference: BonePose
    target: BonePose
    K: np.ndarray

    @property
    def Q(self) -> np.ndarray:
        return multiply(self.motion.turns, self.K)

    def at(self, role: str) -> int:
        return self.bones.roles.index(role)

    def misfit(self, role: str) -> np.ndarray:
        """Angle between source and target bone, degrees, (T,)."""
        b = self.at(role)
        moved = rotate(self.Q[:, b], self.target.directions[b])
        d = self.motion.directions[:, b]
        sine = np.linalg.norm(np.cross(moved, d), axis=-1)
        return np.degrees(np.arctan2(sine, np.sum(moved * d, axis=-1)))


def still(skeleton: Skeleton, bones: Bones) -> BonePose:
    rest = bone_rest(clip_of(skeleton, {}, 1), bones, find_roles(skeleton))
    return BonePose(np.tile([1.0, 0, 0, 0], (len(bones.names), 1)), rest.starts, rest.ends)


def lay(
    clip: SkeletonClip,
    target: Skeleton,
    *,
    turn: np.ndarray | None = None,
    reference: BonePose | None = None,
    standing: np.ndarray | None = None,
    upright: bool = True,
) -> Aligned:
    roles = find_roles(clip.skeleton)
    bones = make_bones(clip.skeleton, tuple(clip.skeleton.names), roles)
    motion = bone_motion(clip, bones, roles)
    reference = bone_rest(clip, bones, roles) if reference is None else reference
    there = still(target, bones)
    if turn is not None:
        there = BonePose(there.turns, rotate(turn, there.starts) + 2.0, rotate(turn, there.ends) + 2.0)
    flat = np.zeros(motion.turns.shape[:2], dtype=bool) if standing is None else standing
    K = align_reference(bones, motion, reference, there, flat, upright)
    return Aligned(bones, motion, reference, there, K)


def random_clip(skeleton: Skeleton, rng: np.random.Generator, T: int = 8) -> SkeletonClip:
    q = near_rotations(rng, (T, skeleton.n_joints), 40)
    rotations = multiply(q, np.broadcast_to(skeleton.rest_rotations, q.shape))
    return SkeletonClip(skeleton, rotations, rng.normal(size=(T, 3)))


def bent_arms(degrees: float) -> Skeleton:
    """The human with its elbows bent forward."""
    A = human_skeleton()
    offsets = np.array(A.offsets)
    tips = np.array(A.tips)
    for side in ("left_", "right_"):
        upper = offsets[A.index(side + "forearm")]
        axis = np.cross(upper, [0, 0, 1.0])
        R = Rotation.from_rotvec(np.radians(degrees) * axis / np.linalg.norm(axis))
        hand = A.index(side + "hand")
        offsets[hand] = R.apply(upper / np.linalg.norm(upper)) * np.linalg.norm(offsets[hand])
        tips[hand] = R.apply(tips[hand])
    return Skeleton(A.names, A.parents, offsets, tips=tips)


@pytest.mark.parametrize("yaw_degrees", [0, 90, 180, -37])
def test_limbs_of_an_a_pose_follow_a_t_pose_exactly(yaw_degrees: float, rng) -> None:
    clip = random_clip(t_pose(), rng)
    laid = lay(clip, human_skeleton(), turn=about("y", yaw_degrees))
    for role in LIMBS + FEET:
        assert laid.misfit(role).max() < 1e-6, role
    # without the alignment the arms are off by the angle between the two rests
    naive = Aligned(laid.bones, laid.motion, laid.reference, laid.target, conjugate(laid.reference.turns))
    assert naive.misfit("left_upper_arm").min() > 40


@pytest.mark.parametrize("yaw_degrees", [0, 90, 180])
def test_trunk_and_head_inherit_the_facing_only(yaw_degrees: float, rng) -> None:
    laid = lay(random_clip(t_pose(), rng), human_skeleton(), turn=about("y", yaw_degrees))
    expected = multiply(laid.motion.turns, about("y", -yaw_degrees))
    for role in TRUNK:
        b = laid.at(role)
        assert_allclose(angle_between(laid.Q[:, b], expected[:, b]), 0, atol=1e-7)


def test_the_same_skeleton_in_the_same_pose_needs_nothing(rng) -> None:
    skeleton = human_skeleton()
    laid = lay(random_clip(skeleton, rng), skeleton)
    assert_allclose(laid.K, np.tile([1.0, 0, 0, 0], (skeleton.n_joints, 1)), atol=1e-12)
    other = lay(rolled(random_clip(skeleton, rng), rng), skeleton)
    assert_allclose(multiply(other.reference.turns, other.K)[:, 0] ** 2, 1, atol=1e-12)


def test_the_same_skeleton_turned_needs_the_turn(rng) -> None:
    skeleton = human_skeleton()
    clip = random_clip(skeleton, rng)
    laid = lay(clip, skeleton, turn=about("y", 90))
    assert_allclose(angle_between(laid.Q, multiply(laid.motion.turns, about("y", -90))), 0, atol=1e-7)


def test_local_axes_mean_nothing(rng) -> None:
    """A skeleton whose joints carry arbitrary axes moves the target just the same."""
    for target in (human_skeleton(), bent_arms(45)):
        clip = random_clip(t_pose(), rng)
        plain, other = lay(clip, target), lay(rolled(clip, rng), target)
        assert_allclose(angle_between(plain.Q, other.Q), 0, atol=1e-6)


def test_scale_means_nothing(rng) -> None:
    clip = random_clip(t_pose(), rng)
    for unit in (1e-2, 1e2):
        assert_allclose(lay(scaled(clip, unit), bent_arms(45)).K, lay(clip, bent_arms(45)).K, atol=1e-9)


def test_a_turned_motion_turns_every_bone(rng) -> None:
    clip = random_clip(t_pose(), rng)
    flat = rng.random((clip.n_frames, clip.skeleton.n_joints)) < 0.6
    for degrees in (90, 180, 251):
        turn = about("y", degrees)
        a = lay(clip, bent_arms(45), standing=flat)
        b = lay(turned(clip, turn), bent_arms(45), standing=flat)
        assert_allclose(angle_between(b.Q, multiply(turn, a.Q)), 0, atol=1e-6)


@pytest.mark.parametrize("flexed", [47, 80])
def test_bent_elbows_bend_about_the_same_axis(flexed: float, rng) -> None:
    """The source's elbow is a hinge; the target's, bent at rest, takes over its axis in both bones."""
    source = t_pose()
    T = 40
    hinge = {"left_": np.array([0, -1.0, 0]), "right_": np.array([0, 1.0, 0])}  # T-pose elbows bend forward
    angle = np.radians(rng.uniform(0, 120, size=T))
    turns = {}
    for side, axis in hinge.items():
        turns[side + "upper_arm"] = near_rotations(rng, (T,), 60)
        turns[side + "forearm"] = wxyz(Rotation.from_rotvec(angle[:, None] * axis))
        turns[side + "hand"] = near_rotations(rng, (T,), 30)
    laid = lay(clip_of(source, turns, T), bent_arms(flexed))
    for side in hinge:
        u, low = laid.at(side + "upper_arm"), laid.at(side + "forearm")
        e = np.cross(laid.target.directions[u], laid.target.directions[low])
        axes = np.cross(laid.motion.directions[:, u], laid.motion.directions[:, low])
        size = np.linalg.norm(axes, axis=1)
        bent = size > 0.1
        now = axes[bent] / size[bent, None]
        for b in (u, low):
            seen = rotate(conjugate(laid.Q[bent, b]), now)
            assert_allclose(seen, np.tile(e / np.linalg.norm(e), (bent.sum(), 1)), atol=1e-6)
        assert laid.misfit(side + "upper_arm").max() < 1e-6
        assert laid.misfit(side + "forearm").max() < 1e-6
        assert laid.misfit(side + "hand").max() < 1e-6


def test_straight_elbows_of_the_target_keep_the_shortest_way(rng) -> None:
    """A nearly straight elbow has no axis worth following."""
    T = 20
    turns = {"left_forearm": wxyz(Rotation.from_rotvec(np.linspace(0, 2, T)[:, None] * [0, -1.0, 0]))}
    laid = lay(clip_of(t_pose(), turns, T), human_skeleton())
    u, low = laid.at("left_upper_arm"), laid.at("left_forearm")
    A = multiply(laid.reference.turns, laid.K)
    # a shortest rotation turns about an axis at right angles to where it starts
    axis = as_rotation(A[u]).as_rotvec()
    assert abs(axis @ laid.target.directions[u]) < 1e-9
    above = rotate(A[u], laid.target.directions[low])
    step = as_rotation(multiply(A[low], conjugate(A[u]))).as_rotvec()
    assert abs(step @ above) < 1e-9


def test_a_source_that_never_bends_gives_no_axis() -> None:
    laid = lay(clip_of(t_pose(), {}, 5), bent_arms(47))
    assert laid.misfit("left_forearm").max() < 1e-6
    assert np.isfinite(laid.K).all()


@pytest.mark.parametrize("spin", [0.0, 2.5])
def test_flat_soles_stay_flat_and_point_where_the_source_does(spin: float, rng) -> None:
    """Whatever the foot's slope and roll in the reference, and though the person turns round meanwhile."""
    source, T = t_pose(), 30
    facing = np.linspace(0.3, 0.3 + spin * np.pi, T)
    # a foot at rest as a converter leaves it: rolled by 20 degrees, and pitched
    crooked = multiply(about("z", 20), about("x", -15))
    clip = clip_of(
        source,
        {"hips": yaw(facing), "left_foot": crooked, "left_toes": multiply(conjugate(crooked), crooked)},
        T,
    )
    standing = np.zeros((T, source.n_joints), dtype=bool)
    laid = lay(clip, human_skeleton())
    standing[5:, [laid.at("left_foot"), laid.at("left_toes")]] = True
    flat = lay(clip, human_skeleton(), standing=standing)
    foot = flat.at("left_foot")
    up = rotate(flat.Q[5:, foot], UP)
    assert_allclose(up, np.tile(UP, (T - 5, 1)), atol=1e-9)
    there = heading(rotate(flat.Q[5:, foot], flat.target.directions[foot]))
    assert_allclose(np.exp(1j * there), np.exp(1j * heading(flat.motion.directions[5:, foot])), atol=1e-9)
    # by direction alone the sole would tilt with the reference
    assert np.degrees(np.arccos(rotate(laid.Q[5:, foot], UP) @ UP)).min() > 5


def test_the_lean_of_a_frame_picked_from_the_motion_is_taken_out_of_the_trunk() -> None:
    skeleton = human_skeleton()
    roles = find_roles(skeleton)
    bones = make_bones(skeleton, skeleton.names, roles)
    low, high = bones.roles.index("hips"), bones.roles.index("neck")
    for degrees, out in ((30, True), (8, False)):
        leaning = clip_of(skeleton, {"hips": about("x", degrees), "left_upper_arm": about("z", 20)}, 2)
        pose = bone_motion(leaning, bones, roles).frame(0)
        laid = lay(leaning, skeleton, reference=pose, upright=False)
        A = multiply(laid.reference.turns, laid.K)
        tilted = rotate(A[low], laid.target.starts[high] - laid.target.starts[low])
        trunk = pose.starts[high] - pose.starts[low]
        angle = np.degrees(np.arccos(tilted @ trunk / np.linalg.norm(tilted) / np.linalg.norm(trunk)))
        assert angle == pytest.approx(0 if out else degrees, abs=1e-4)
        # read as upright, nothing is taken out
        up = lay(leaning, skeleton, reference=pose, upright=True)
        assert_allclose(multiply(up.reference.turns, up.K)[low], [1, 0, 0, 0], atol=1e-9)


def test_limb_angles_are_the_angles_between_limbs(rng) -> None:
    source, target = t_pose(), human_skeleton()
    roles = find_roles(source)
    bones = make_bones(source, source.names, roles)
    rest, there = still(source, bones), still(target, bones)
    angles = limb_angles(bones, rest, there)
    for role in ("left_upper_arm", "right_shin", "left_hand"):
        b = bones.roles.index(role)
        cosine = rest.directions[b] @ there.directions[b]
        assert angles[b] == pytest.approx(np.arccos(np.clip(cosine, -1, 1)), abs=1e-7)
    # whichever way the source faces, and wherever it is
    motion = bone_motion(turned(clip_of(source, {}, 3), about("y", 123)), bones, roles)
    assert_allclose(limb_angles(bones, motion, there), np.tile(angles, (3, 1)), atol=1e-7)
    assert limb_angles(bones, there, there).max() < 1e-7
    unknown = BonePose(there.turns, there.starts, there.starts)
    assert_allclose(limb_angles(bones, rest, unknown), 0)


@pytest.mark.parametrize(
    ("turns", "upright"),
    [
        ({}, True),
        ({"hips": about("y", 170)}, True),
        ({"hips": about("x", 30)}, True),
        ({"hips": about("x", 90)}, False),
        ({"hips": about("x", 180)}, False),
        ({"left_thigh": about("x", -90)}, False),
        ({"right_shin": about("x", 70)}, False),
        ({"left_upper_arm": about("z", 120)}, True),
    ],
)
def test_standing_upright_is_trunk_up_and_legs_down(turns: dict[str, np.ndarray], upright: bool) -> None:
    skeleton = human_skeleton()
    roles = find_roles(skeleton)
    bones = make_bones(skeleton, skeleton.names, roles)
    pose = bone_motion(clip_of(skeleton, turns, 1), bones, roles).frame(0)
    assert stands_upright(bones, pose) == upright


def test_of_a_body_without_known_limbs_nothing_can_be_said() -> None:
    skeleton = human_skeleton()
    bones = make_bones(skeleton, skeleton.names, {})
    pose = bone_motion(clip_of(skeleton, {"hips": about("x", 180)}, 1), bones, {}).frame(0)
    assert stands_upright(bones, pose)
