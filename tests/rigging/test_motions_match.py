"""A motion keeps its poses on another skeleton, whatever that one's rest, bases, names and size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rig_bodies import human_skin, random_rig

from tempose import formats
from tempose.clips import Skeleton, SkeletonClip
from tempose.formats.bvh_write import zero_at_rest
from tempose.kinematics import find_roles, forward_kinematics, rest_transforms
from tempose.rigging.motions import match_motion, matched_motion, pair_joints, read_mapping
from tempose.rigging.motions.names import same_names
from tempose.rotations import angle_between, conjugate, from_rotation_vector, multiply, normalise, rotate
from tempose.samples import MOTIONS

RIG = random_rig(human_skin(), frames=6, size=0.4)
SKELETON, MOTION = RIG.skin.skeleton, RIG.motion


def places(motion: SkeletonClip) -> np.ndarray:
    return forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)[1]


def rebased(motion: SkeletonClip, seed: int = 0) -> SkeletonClip:
    """The same motion with another basis in every joint."""
    rng = np.random.default_rng(seed)
    skeleton = motion.skeleton
    own = normalise(rng.normal(size=(skeleton.n_joints, 4)))
    above = np.concatenate([[[1.0, 0, 0, 0]], own[skeleton.parents[1:]]])
    turned = Skeleton(
        skeleton.names,
        skeleton.parents,
        np.concatenate([skeleton.offsets[:1], rotate(conjugate(above), skeleton.offsets)[1:]]),
        multiply(conjugate(above), multiply(np.asarray(skeleton.rest_rotations), own)),
        rotate(conjugate(own), np.asarray(skeleton.tips)),
    )
    rotations = multiply(conjugate(above), multiply(motion.rotations, own))
    return replace(motion, skeleton=turned, rotations=rotations)


def at_other_rest(motion: SkeletonClip, pose: np.ndarray) -> SkeletonClip:
    """The same motion of a skeleton that rests in another pose, its bases those of the world there."""
    posed = replace(motion.skeleton, rest_rotations=pose)
    skeleton, rotations = zero_at_rest(posed, motion.rotations)
    return replace(motion, skeleton=skeleton, rotations=rotations)


def renamed(motion: SkeletonClip, name) -> SkeletonClip:
    skeleton = replace(motion.skeleton, names=tuple(map(name, motion.skeleton.names)))
    return replace(motion, skeleton=skeleton)


def same(motion: SkeletonClip, other: SkeletonClip = MOTION, atol: float = 1e-9) -> None:
    assert motion.skeleton.names == SKELETON.names
    assert angle_between(motion.rotations, other.rotations).max() < atol
    assert_allclose(motion.root_position, other.root_position, atol=atol)


def test_our_own_motion_is_left_alone():
    result = matched_motion(SKELETON, MOTION)
    same(result.motion)
    assert result.warnings == () and result.scale == 1.0 and result.motion.fps == MOTION.fps


def test_bases_of_the_joints_do_not_matter():
    same(match_motion(SKELETON, rebased(MOTION)), atol=1e-7)


def test_rest_pose_of_the_motion_does_not_matter_where_bases_are_kept():
    # a T-pose for an A-pose, all else equal
    rng = np.random.default_rng(3)
    turned = from_rotation_vector(0.4 * rng.normal(size=(SKELETON.n_joints, 3)))
    pose = multiply(np.asarray(SKELETON.rest_rotations), turned)
    other = replace(MOTION, skeleton=replace(SKELETON, rest_rotations=pose))
    same(match_motion(SKELETON, other), atol=1e-7)


def test_bones_go_where_they_went_when_rest_pose_and_bases_are_others():
    rng = np.random.default_rng(3)
    turned = from_rotation_vector(0.4 * rng.normal(size=(SKELETON.n_joints, 3)))
    pose = multiply(np.asarray(SKELETON.rest_rotations), turned)
    result = match_motion(SKELETON, at_other_rest(MOTION, pose))
    assert_allclose(places(result), places(MOTION), atol=1e-9)


@pytest.mark.parametrize("size", [1e-3, 0.37, 25.4, 1e3])
def test_unit_of_the_motion_does_not_matter(size):
    skeleton = replace(SKELETON, offsets=size * SKELETON.offsets, tips=size * np.asarray(SKELETON.tips))
    same(
        match_motion(SKELETON, replace(MOTION, skeleton=skeleton, root_position=size * MOTION.root_position))
    )


@pytest.mark.parametrize("up", ["x", "z"])
def test_axes_taken_wrongly_are_turned_back(tmp_path, up):
    formats.save(tmp_path / "a.bvh", MOTION)
    wrong = formats.load_skeleton_clip(tmp_path / "a.bvh", up=up, unit=1.0)
    result = matched_motion(SKELETON, wrong)
    same(result.motion, atol=1e-6)
    assert any("other axes" in line for line in result.warnings)


@pytest.mark.parametrize("ending", ["bvh", "glb", "usda"])
def test_files_come_back(tmp_path, ending):
    if ending == "usda":
        pytest.importorskip("pxr")
    from tempose.rigging.export import export_rig

    export_rig(RIG, tmp_path / f"a.{ending}")
    motion = formats.load_skeleton_clip(tmp_path / f"a.{ending}")
    same(match_motion(SKELETON, motion), atol=1e-5)
    assert motion.fps == MOTION.fps


@pytest.mark.parametrize(
    "name",
    [
        lambda n: f"mixamorig:{n}",
        lambda n: f"Armature|{n}".upper(),
        lambda n: n.replace("_", " "),
        lambda n: f"{n}.001",
        lambda n: n.replace("_", "."),
    ],
)
def test_spellings_of_programs_are_read(name):
    result = matched_motion(SKELETON, renamed(MOTION, name))
    same(result.motion)
    assert not result.pairs.by_role and not result.warnings


def test_order_of_joints_and_more_joints_do_not_matter():
    skeleton, motion = SKELETON, MOTION
    extra = Skeleton(
        (*skeleton.names, "prop"),
        np.append(skeleton.parents, 3),
        np.vstack([skeleton.offsets, [[1.0, 0, 0]]]),
        np.vstack([np.asarray(skeleton.rest_rotations), [[1.0, 0, 0, 0]]]),
    )
    rotations = np.concatenate([motion.rotations, np.tile([1.0, 0, 0, 0], (6, 1, 1))], axis=1)
    result = matched_motion(skeleton, replace(motion, skeleton=extra, rotations=rotations))
    same(result.motion)
    assert result.pairs.unused == ("prop",)


def test_a_mapping_wins_and_is_checked(tmp_path):
    numbered = renamed(MOTION, lambda n: f"joint_{SKELETON.names.index(n)}")
    with pytest.raises(ValueError, match=r"no joints for .*hips.*it has joint_0.*mapping"):
        match_motion(SKELETON, numbered)
    mapping = {f"joint_{j}": name for j, name in enumerate(SKELETON.names)}
    same(match_motion(SKELETON, numbered, mapping))
    with pytest.raises(ValueError, match="mapping names a joint 'nothing'; the motion has"):
        match_motion(SKELETON, numbered, {"nothing": SKELETON.names[0]})
    with pytest.raises(ValueError, match="mapping names a joint 'elbow'; the rig has"):
        match_motion(SKELETON, numbered, {"joint_0": "elbow"})
    with pytest.raises(ValueError, match="two joints of the motion"):
        match_motion(SKELETON, numbered, {"joint_0": SKELETON.names[0], "joint_1": SKELETON.names[0]})
    (tmp_path / "map.json").write_text('{"joint_0": "hips"}')
    assert read_mapping(tmp_path / "map.json") == {"joint_0": "hips"}
    (tmp_path / "map.json").write_text('{"joint_0": 3}')
    with pytest.raises(ValueError, match=r"map\.json: expected the name"):
        read_mapping(tmp_path / "map.json")


def test_missing_joints_rest_where_that_is_allowed():
    keep = [j for j in range(SKELETON.n_joints) if SKELETON.names[j] not in ("left_forearm", "left_hand")]
    parents = [-1, *(keep.index(int(SKELETON.parents[j])) for j in keep[1:])]
    less = Skeleton(
        tuple(SKELETON.names[j] for j in keep),
        np.array(parents),
        SKELETON.offsets[keep],
        np.asarray(SKELETON.rest_rotations)[keep],
    )
    motion = replace(MOTION, skeleton=less, rotations=MOTION.rotations[:, keep])
    with pytest.raises(ValueError, match="no joints for left_forearm"):
        match_motion(SKELETON, motion)
    result = matched_motion(SKELETON, motion, missing="rest")
    j = SKELETON.index("left_forearm")
    rest = np.asarray(SKELETON.rest_rotations)[j]
    assert angle_between(result.motion.rotations[:, j], rest).max() < 1e-12
    assert "left_forearm" in result.pairs.missing and any("left_forearm" in w for w in result.warnings)
    assert result.warnings[0] in result.motion.source.notes
    with pytest.raises(ValueError, match="missing must be"):
        match_motion(SKELETON, motion, missing="zero")


def test_limbs_of_another_body_point_as_its_limbs_do():
    walk = MOTIONS["human"]["walk"](SKELETON, duration=1.0)
    rng = np.random.default_rng(0)
    other = replace(SKELETON, offsets=SKELETON.offsets * rng.uniform(0.7, 1.4, size=(SKELETON.n_joints, 1)))
    away = from_rotation_vector(np.array([0, 0.9, 0]))
    rest = np.array(other.rest_rotations)
    rest[0] = multiply(away, rest[0])
    theirs = SkeletonClip(replace(other, rest_rotations=rest), walk.rotations, walk.root_position, walk.fps)
    ours = matched_motion(SKELETON, theirs)
    here, there = places(ours.motion), places(theirs)
    roles = find_roles(SKELETON)
    for side in ("left", "right"):
        for start, end in (
            ("upper_arm", "forearm"),
            ("forearm", "hand"),
            ("thigh", "shin"),
            ("shin", "foot"),
        ):
            a, b = roles[f"{side}_{start}"], roles[f"{side}_{end}"]
            u, v = here[:, b] - here[:, a], there[:, b] - there[:, a]
            cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 1e-4
    # it faces where the other faces, whichever way that one's rest pose faces
    assert angle_between(ours.motion.rotations[:, 0], walk.rotations[:, 0]).max() < 0.02
    floor = rest_transforms(SKELETON)[1][:, 1].min()
    assert abs(np.percentile(here[..., 1].min(axis=1), 5) - floor) < 1e-9


def test_hands_keep_their_twist_when_the_other_rests_with_raised_arms():
    walk = MOTIONS["human"]["walk"](SKELETON, duration=0.5)
    roles, (world, rest) = find_roles(SKELETON), rest_transforms(SKELETON)
    pose = np.array(SKELETON.rest_rotations)
    arms = [roles["left_upper_arm"], roles["right_upper_arm"]]
    for j in arms:
        bone = rest[SKELETON.children(j)[0]] - rest[j]
        # about an axis across the bone, so that the shortest way back is the way it came
        axis = np.cross(bone, [0.3, 0.2, 1.0])
        lift = from_rotation_vector(0.9 * axis / np.linalg.norm(axis))
        pose[j] = multiply(conjugate(world[SKELETON.parents[j]]), multiply(lift, world[j]))
    theirs = at_other_rest(walk, pose)
    stretched = np.array(theirs.skeleton.offsets)
    stretched[[roles["left_shin"], roles["right_shin"]]] *= 1.3
    theirs = replace(theirs, skeleton=replace(theirs.skeleton, offsets=stretched))
    ours = matched_motion(SKELETON, theirs)
    before = forward_kinematics(SKELETON, walk.rotations, walk.root_position)[0]
    after = forward_kinematics(SKELETON, ours.motion.rotations, ours.motion.root_position)[0]
    below = [
        roles[f"{side}_{part}"] for side in ("left", "right") for part in ("upper_arm", "forearm", "hand")
    ]
    assert angle_between(before, after)[:, below].max() < 1e-6
    assert 40 < ours.rest_angles[arms].max() < 60 and any("look at the result" in w for w in ours.warnings)


def test_travel_goes_with_the_length_of_the_legs():
    roles = find_roles(SKELETON)
    offsets = np.array(SKELETON.offsets)
    for role in ("left_shin", "right_shin", "left_foot", "right_foot"):
        offsets[roles[role]] *= 1.25
    theirs = replace(MOTION, skeleton=replace(SKELETON, offsets=offsets))
    result = matched_motion(SKELETON, theirs)
    assert abs(result.scale - 0.8) < 1e-9
    travel = np.ptp(result.motion.root_position[:, [0, 2]], axis=0)
    assert_allclose(travel, 0.8 * np.ptp(MOTION.root_position[:, [0, 2]], axis=0))


def test_another_kind_of_body_is_refused_by_name():
    from tempose.samples import animal_skeleton

    animal = animal_skeleton()
    motion = SkeletonClip(animal, np.asarray(animal.rest_rotations)[None], animal.offsets[:1])
    with pytest.raises(ValueError, match="the motion has no joints for"):
        match_motion(SKELETON, motion)


def test_ambiguous_spellings_pair_nothing():
    assert same_names(["arm"], ["Arm", "ARM"]) == {}
    assert same_names(["arm", "Arm"], ["ARM"]) == {}
    assert same_names(["arm", "Arm"], ["Arm", "x:arm"]) == {"Arm": "Arm", "arm": "x:arm"}


def test_pairs_name_who_is_left_over():
    pairs = pair_joints(
        SKELETON, replace(SKELETON, names=("Hips", *(f"b{j}" for j in range(1, SKELETON.n_joints))))
    )
    assert len(pairs.source) == 1 and len(pairs.missing) == SKELETON.n_joints - 1
    assert set(pairs.needed) <= set(pairs.missing) and "left_shin" in pairs.needed


@pytest.mark.real
def test_captures_drive_another_human(data_folder):
    for folder, file, frame in (
        ("mocap-cmu", "cmu_12_01_walk.bvh", False),
        ("mocap-bandai-namco", "dataset-1_bow_normal_001.bvh", True),
    ):
        theirs = formats.load_skeleton_clip(data_folder(folder) / file)
        result = matched_motion(SKELETON, theirs)
        assert any("no standing pose" in line for line in result.warnings) == frame
        here = places(result.motion)
        roles = find_roles(SKELETON)
        up = here[:, roles["head"], 1] - here[:, roles["hips"], 1]
        assert up.min() > 0.1 * human_skin().mesh.height
        source = find_roles(theirs.skeleton)
        there = places(theirs)
        for role in ("left_thigh", "right_shin", "left_upper_arm"):
            j, k = roles[role], source[role]
            child, other = SKELETON.children(j)[0], theirs.skeleton.children(k)[0]
            u, v = here[:, child] - here[:, j], there[:, other] - there[:, k]
            cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 1.0
