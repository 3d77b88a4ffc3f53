"""Roles: exact tables for the skeletons of many makers, and bones that point where anatomy says."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Skeleton
from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.kinematics import (
    ROLES,
    bone_axis,
    bone_ends,
    bones_of_role,
    find_roles,
    forward_kinematics,
    rest_transforms,
    role_lengths,
    side_contradictions,
)
from tempose.kinematics.joint_names import read_names

ARM = ("clavicle", "upper_arm", "forearm", "hand")
LEG = ("thigh", "shin", "foot", "toes")


def tree(text, mirror=()):
    """A skeleton from nested text; lines that `mirror` changes appear for the right side too."""
    lines = [line for line in text.splitlines() if line.strip()]
    names, parents, stack = [], [], []
    for line in lines:
        depth = len(line) - len(line.lstrip())
        stack = [*stack[:depth], len(names)]
        names.append(line.strip())
        parents.append(stack[-2] if depth else -1)
    if mirror:
        twins = {j: re.sub(*mirror, name) for j, name in enumerate(names) if re.search(mirror[0], name)}
        index = {j: len(names) + k for k, j in enumerate(twins)}
        for j, name in twins.items():
            names.append(name)
            parents.append(index.get(parents[j], parents[j]))
    offsets = np.arange(len(names))[:, None] * [[0.01, 0.02, 0.0]] + [0.0, 0.1, 0.0]
    return Skeleton(tuple(names), np.array(parents), offsets)


def table(trunk, arm, leg, mirror):
    """Expected roles from three rows of names; a dash where the role is missing."""
    expected = dict(zip(ROLES[:5], trunk.split("|")))
    for side in ("left", "right"):
        for part, name in zip(ARM + LEG, f"{arm}|{leg}".split("|")):
            expected[f"{side}_{part}"] = name if side == "left" else re.sub(*mirror, name)
    return {role: name for role, name in expected.items() if name != "-"}


def named(skeleton, roles):
    return {role: skeleton.names[j] for role, j in roles.items()}


MIXAMO = """
m:Hips
 m:Spine
  m:Spine1
   m:Spine2
    m:Neck
     m:Head
      m:HeadTop_End
      m:LeftEye
    m:LeftShoulder
     m:LeftArm
      m:LeftForeArm
       m:LeftHand
        m:LeftHandThumb1
        m:LeftHandIndex1
        m:LeftHandMiddle1
 m:LeftUpLeg
  m:LeftLeg
   m:LeftFoot
    m:LeftToeBase
     m:LeftToe_End
"""
HIK = """
Fight_Hips
 Fight_LeftUpLeg
  Fight_LeftUpLegRoll
   Fight_LeftLeg
    Fight_LeftFoot
     Fight_LeftToeBase
 Fight_Spine
  Fight_Spine1
   Fight_Neck
    Fight_Head
   Fight_LeftShoulder
    Fight_LeftArm
     Fight_LeftArmRoll
      Fight_LeftForeArm
       Fight_LeftHand
        Fight_LeftHandAttach
        Fight_LeftFingerBase
"""
UNREAL = """
root
 pelvis
  spine_01
   spine_02
    spine_03
     clavicle_l
      upperarm_l
       lowerarm_l
        hand_l
         middle_01_l
        lowerarm_twist_01_l
       upperarm_twist_01_l
     neck_01
      head
  thigh_l
   calf_l
    calf_twist_01_l
    foot_l
     ball_l
   thigh_twist_01_l
 ik_foot_root
  ik_foot_l
 ik_hand_root
  ik_hand_l
"""
RIGIFY = """
root
 DEF-spine
  DEF-spine.001
   DEF-spine.002
    DEF-spine.003
     DEF-spine.004
      DEF-spine.005
       DEF-spine.006
     DEF-shoulder.L
      DEF-upper_arm.L
       DEF-upper_arm.L.001
        DEF-forearm.L
         DEF-forearm.L.001
          DEF-hand.L
  DEF-pelvis.L
  DEF-thigh.L
   DEF-thigh.L.001
    DEF-shin.L
     DEF-shin.L.001
      DEF-foot.L
       DEF-toe.L
"""
BIPED = """
Bip01
 Bip01 Footsteps
 Bip01 Pelvis
  Bip01 Spine
   Bip01 L Thigh
    Bip01 L Calf
     Bip01 L Foot
      Bip01 L Toe0
   Bip01 Spine1
    Bip01 Neck
     Bip01 Head
      Bip01 HeadNub
     Bip01 L Clavicle
      Bip01 L UpperArm
       Bip01 L Forearm
        Bip01 L Hand
         Bip01 L Finger0
         Bip01 L Finger2
"""
GENESIS = """
Figure
 hip
  pelvis
   lThighBend
    lThighTwist
     lShin
      lFoot
       lMetatarsals
        lToe
         lBigToe
  abdomenLower
   abdomenUpper
    chestLower
     chestUpper
      lCollar
       lShldrBend
        lShldrTwist
         lForearmBend
          lForearmTwist
           lHand
            lThumb1
      neckLower
       neckUpper
        head
         upperTeeth
"""
VRM = """
Root
 J_Bip_C_Hips
  J_Bip_C_Spine
   J_Bip_C_Chest
    J_Bip_C_UpperChest
     J_Bip_C_Neck
      J_Bip_C_Head
     J_Bip_L_Shoulder
      J_Bip_L_UpperArm
       J_Bip_L_LowerArm
        J_Bip_L_Hand
  J_Bip_L_UpperLeg
   J_Bip_L_LowerLeg
    J_Bip_L_Foot
     J_Bip_L_ToeBase
"""
SMPL = """
pelvis
 left_hip
  left_knee
   left_ankle
    left_foot
 spine1
  spine2
   spine3
    neck
     head
    left_collar
     left_shoulder
      left_elbow
       left_wrist
        left_hand
"""
KINECT = """
SpineBase
 SpineMid
  SpineShoulder
   Neck
    Head
   ShoulderLeft
    ElbowLeft
     WristLeft
      HandLeft
 HipLeft
  KneeLeft
   AnkleLeft
    FootLeft
"""
LINKS = """
torso_joint_1
 torso_joint_2
  torso_joint_3
   neck_joint_1
    neck_joint_2
   arm_joint_L__4_
    arm_joint_L__3_
     arm_joint_L__2_
 leg_joint_L_1
  leg_joint_L_2
   leg_joint_L_3
    leg_joint_L_5
"""
LIFEFORMS = """
Hips
 LeftHip
  LeftKnee
   LeftAnkle
    LeftToe
 Chest
  LeftCollar
   LeftShoulder
    LeftElbow
     LeftWrist
  Neck
   Head
"""
RIGS = [
    ("mixamo", MIXAMO, ("Left", "Right"), "m:Hips|m:Spine|m:Spine2|m:Neck|m:Head",
     "m:LeftShoulder|m:LeftArm|m:LeftForeArm|m:LeftHand", "m:LeftUpLeg|m:LeftLeg|m:LeftFoot|m:LeftToeBase"),
    ("hik", HIK, ("Left", "Right"), "Fight_Hips|Fight_Spine|Fight_Spine1|Fight_Neck|Fight_Head",
     "Fight_LeftShoulder|Fight_LeftArm|Fight_LeftForeArm|Fight_LeftHand",
     "Fight_LeftUpLeg|Fight_LeftLeg|Fight_LeftFoot|Fight_LeftToeBase"),
    ("unreal", UNREAL, ("_l$", "_r"), "pelvis|spine_01|spine_03|neck_01|head",
     "clavicle_l|upperarm_l|lowerarm_l|hand_l", "thigh_l|calf_l|foot_l|ball_l"),
    ("rigify", RIGIFY, (r"\.L", ".R"), "DEF-spine|DEF-spine.001|DEF-spine.003|DEF-spine.004|DEF-spine.006",
     "DEF-shoulder.L|DEF-upper_arm.L|DEF-forearm.L|DEF-hand.L",
     "DEF-thigh.L|DEF-shin.L|DEF-foot.L|DEF-toe.L"),
    ("biped", BIPED, (" L ", " R "), "Bip01 Pelvis|Bip01 Spine|Bip01 Spine1|Bip01 Neck|Bip01 Head",
     "Bip01 L Clavicle|Bip01 L UpperArm|Bip01 L Forearm|Bip01 L Hand",
     "Bip01 L Thigh|Bip01 L Calf|Bip01 L Foot|Bip01 L Toe0"),
    ("genesis", GENESIS, ("^l(?=[A-Z])", "r"), "hip|abdomenLower|chestUpper|neckLower|head",
     "lCollar|lShldrBend|lForearmBend|lHand", "lThighBend|lShin|lFoot|lToe"),
    ("vrm", VRM, ("_L_", "_R_"), "J_Bip_C_Hips|J_Bip_C_Spine|J_Bip_C_UpperChest|J_Bip_C_Neck|J_Bip_C_Head",
     "J_Bip_L_Shoulder|J_Bip_L_UpperArm|J_Bip_L_LowerArm|J_Bip_L_Hand",
     "J_Bip_L_UpperLeg|J_Bip_L_LowerLeg|J_Bip_L_Foot|J_Bip_L_ToeBase"),
    ("smpl", SMPL, ("left", "right"), "pelvis|spine1|spine3|neck|head",
     "left_collar|left_shoulder|left_elbow|left_wrist", "left_hip|left_knee|left_ankle|left_foot"),
    ("kinect", KINECT, ("Left", "Right"), "SpineBase|SpineMid|SpineShoulder|Neck|Head",
     "-|ShoulderLeft|ElbowLeft|WristLeft", "HipLeft|KneeLeft|AnkleLeft|FootLeft"),
    ("links", LINKS, ("_L_", "_R_"), "torso_joint_1|torso_joint_2|torso_joint_3|neck_joint_1|-",
     "-|arm_joint_L__4_|arm_joint_L__3_|arm_joint_L__2_",
     "leg_joint_L_1|leg_joint_L_2|leg_joint_L_3|leg_joint_L_5"),
    ("lifeforms", LIFEFORMS, ("Left", "Right"), "Hips|Chest|-|Neck|Head",
     "LeftCollar|LeftShoulder|LeftElbow|LeftWrist", "LeftHip|LeftKnee|LeftAnkle|LeftToe"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "mirror", "trunk", "arm", "leg"), [r[1:] for r in RIGS], ids=[r[0] for r in RIGS]
)
def test_naming_customs_map_onto_one_vocabulary(text, mirror, trunk, arm, leg):
    skeleton = tree(text, mirror)
    assert named(skeleton, find_roles(skeleton)) == table(trunk, arm, leg, mirror)


REAL = {
    "cmu-bvh": (
        "Hips|LowerBack|Spine1|Neck|Head", "LeftShoulder|LeftArm|LeftForeArm|LeftHand",
        "LeftUpLeg|LeftLeg|LeftFoot|LeftToeBase", ("Left", "Right"),
    ),
    "cmu-asf": (
        "root|lowerback|thorax|lowerneck|head", "lclavicle|lhumerus|lradius|lwrist",
        "lfemur|ltibia|lfoot|ltoes", ("^l", "r"),
    ),
    "bandai": (
        "Hips|Spine|Chest|Neck|Head", "Shoulder_L|UpperArm_L|LowerArm_L|Hand_L",
        "UpperLeg_L|LowerLeg_L|Foot_L|Toes_L", ("_L$", "_R"),
    ),
    "makehuman-walk": (
        "Hips|Spine1|Spine3|Neck|Head", "Clavicle_L|UpArm_L|LoArm_L|Hand_L", "UpLeg_L|LoLeg_L|Foot_L|Toe_L",
        ("_L$", "_R"),
    ),
    "makehuman-pose": (
        "root|spine05|spine01|neck01|head", "clavicle.L|upperarm01.L|lowerarm01.L|wrist.L",
        "upperleg01.L|lowerleg01.L|foot.L|toe1-1.L", (r"\.L$", ".R"),
    ),
    "makehuman": (
        "root|spine05|spine01|neck01|head", "clavicle.L|upperarm01.L|lowerarm01.L|wrist.L",
        "upperleg01.L|lowerleg01.L|foot.L|toe1-1.L", (r"\.L$", ".R"),
    ),
    "mesh2motion": (
        "pelvis|spine_01|spine_03|neck_01|head", "clavicle_l|upperarm_l|lowerarm_l|hand_l",
        "thigh_l|calf_l|foot_l|ball_l", ("_l$", "_r"),
    ),
}  # fmt: skip
CLIPS = {
    "cmu-bvh": "mocap-cmu/cmu_12_01_walk.bvh",
    "cmu-asf": "mocap-cmu/02_03.amc",
    "bandai": "mocap-bandai-namco/dataset-1_run_normal_001.bvh",
    "makehuman-walk": "makehuman-base/walk1.bvh",
    "makehuman-pose": "makehuman-base/tpose.bvh",
}


@pytest.fixture(scope="module")
def pose(data_folder):
    """Skeleton, world rotations and positions of a real character, moving where there is motion."""

    def load(name):
        if name in CLIPS:
            folder, file = CLIPS[name].split("/")
            clip = load_skeleton_clip(data_folder(folder) / file)
            return clip.skeleton, *forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)
        if name == "makehuman":
            folder = data_folder("makehuman-base")
            skin = load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj"))
        else:
            skin = load_skin(data_folder("rigged-gltf") / "human-male.glb")
        return skin.skeleton, *rest_transforms(skin.skeleton)

    return load


@pytest.mark.real
@pytest.mark.parametrize("name", REAL)
def test_real_skeletons_map_onto_one_vocabulary(pose, name):
    skeleton = pose(name)[0]
    roles = find_roles(skeleton)
    assert tuple(roles) == ROLES
    assert named(skeleton, roles) == table(*REAL[name])


@pytest.mark.real
@pytest.mark.parametrize("name", REAL)
def test_left_is_left_in_real_poses_and_a_mirror_is_noticed(pose, name):
    skeleton, turns, points = pose(name)
    roles = find_roles(skeleton)
    assert side_contradictions(skeleton, points, turns, roles) == ()
    swapped = dict(roles)
    for part in ARM + LEG[:2]:
        left, right = f"left_{part}", f"right_{part}"
        swapped[left], swapped[right] = roles[right], roles[left]
    assert side_contradictions(skeleton, points, turns, swapped) == (
        "The left thigh lies right of where the feet point: mirrored names or axes.",
        "The left upper arm lies right of where the feet point: mirrored names or axes.",
    )


@pytest.mark.real
@pytest.mark.parametrize("name", REAL)
def test_bones_of_standing_bodies_point_where_anatomy_says(pose, name):
    skeleton, turns, points = pose(name)
    axes = bone_axis(skeleton, points, turns, find_roles(skeleton))
    assert tuple(axes) == ROLES

    def mean(role):
        axis = axes[role].reshape(-1, 3)
        return np.median(axis / np.linalg.norm(axis, axis=1, keepdims=True), axis=0)

    assert min(np.linalg.norm(axis, axis=-1).min() for axis in axes.values()) > 0.01
    for role in ("spine", "chest", "head"):
        assert mean(role)[1] > 0.7
    for side in ("left", "right"):
        assert mean(f"{side}_thigh")[1] < -0.6 and mean(f"{side}_shin")[1] < -0.3
        assert mean(f"{side}_foot")[1] < 0.1


@pytest.mark.real
@pytest.mark.parametrize("name", REAL)
def test_every_joint_belongs_to_one_role(pose, name):
    skeleton = pose(name)[0]
    roles = find_roles(skeleton)
    bones = bones_of_role(skeleton, roles)
    assert sorted(np.concatenate(list(bones.values()))) == list(range(skeleton.n_joints))
    assert all(roles[role] in bones[role] for role in ROLES)


@pytest.mark.real
def test_helpers_move_with_the_role_above_them(pose):
    skeleton = pose("cmu-bvh")[0]
    bones = bones_of_role(skeleton, find_roles(skeleton))
    assert [skeleton.names[j] for j in bones["hips"]] == ["Hips", "LHipJoint", "RHipJoint"]
    assert [skeleton.names[j] for j in bones["left_hand"]] == [
        "LeftHand", "LeftFingerBase", "LeftHandIndex1", "LThumb",
    ]  # fmt: skip
    skeleton = pose("makehuman")[0]
    bones = {
        k: {skeleton.names[j] for j in v} for k, v in bones_of_role(skeleton, find_roles(skeleton)).items()
    }
    assert {"jaw", "eye.L", "tongue00"} < bones["head"]
    assert bones["left_forearm"] == {"lowerarm01.L", "lowerarm02.L"}
    assert {"toe1-1.L", "toe5-3.L"} < bones["left_toes"] and bones["left_foot"] == {"foot.L"}
    assert bones["left_clavicle"] == {"clavicle.L", "shoulder01.L"}
    assert bones["hips"] == {"root", "pelvis.L", "pelvis.R"}


@pytest.mark.real
def test_joints_on_one_spot_are_skipped(pose):
    skeleton = pose("cmu-bvh")[0]
    ends = bone_ends(skeleton, find_roles(skeleton))
    names = {role: skeleton.names[bone.end] for role, bone in ends.items() if bone.tip is None}
    assert (names["hips"], names["spine"], names["chest"]) == ("Spine", "Spine1", "Neck1")
    assert names["left_hand"] == "LeftHandIndex1"
    assert_allclose(ends["left_toes"].tip, skeleton.tips[skeleton.index("LeftToeBase")])
    skeleton = pose("makehuman")[0]
    ends = bone_ends(skeleton, find_roles(skeleton))
    assert skeleton.names[ends["left_hand"].end] == "finger3-1.L"
    skeleton = pose("mesh2motion")[0]
    ends = bone_ends(skeleton, find_roles(skeleton))
    names = {role: skeleton.names[bone.end] for role, bone in ends.items()}
    assert (names["left_hand"], names["head"], names["right_toes"]) == (
        "middle_01_l",
        "head_leaf",
        "ball_leaf_r",
    )


def test_axis_is_turned_with_its_joint_and_lengths_are_those_of_rest(rng):
    names = ("pelvis", "thigh_l", "calf_l", "foot_l", "ball_l")
    offsets = np.array([[0, 1, 0], [0.1, 0, 0], [0, -0.4, 0], [0, -0.5, 0], [0, 0, 0.2]])
    tips = np.full((5, 3), np.nan)
    tips[4] = [0, 0, 0.07]
    skeleton = Skeleton(names, np.arange(-1, 4), offsets, tips=tips)
    roles = find_roles(skeleton)
    lengths = role_lengths(skeleton, roles)
    expected = {"left_thigh": 0.4, "left_shin": 0.5, "left_foot": 0.2, "left_toes": 0.07}
    assert lengths == pytest.approx(expected)
    q = rng.normal(size=(6, 5, 4))
    turns, points = forward_kinematics(
        skeleton, q / np.linalg.norm(q, axis=-1, keepdims=True), np.zeros((6, 3))
    )
    axes = bone_axis(skeleton, points, turns, roles)
    for role, length in expected.items():
        assert axes[role].shape == (6, 3)
        assert_allclose(np.linalg.norm(axes[role], axis=-1), length, rtol=1e-9)
    assert_allclose(axes["left_shin"], points[:, 3] - points[:, 2])


def test_a_bone_of_unknown_length_continues_the_one_before():
    skeleton = tree(SMPL, ("left", "right"))
    roles = find_roles(skeleton)
    turns, points = rest_transforms(skeleton)
    axes = bone_axis(skeleton, points, turns, roles)
    assert_allclose(axes["head"], axes["neck"])
    assert_allclose(axes["left_toes"], axes["left_foot"])
    assert bone_ends(skeleton, roles)["left_hand"].end == skeleton.index("left_hand")


QUADRUPED = """
root
 hips
  spine_1
   spine_2
    head
    front_humerus_l
     front_leg_upper_l
      front_leg_lower_l
  back_leg_upper_l
   back_leg_lower_l
    back_leg_foot_l
  tail_1
"""


@pytest.mark.parametrize("text", [QUADRUPED, "a\n b\n  c", "Hips\n Spine\n  Head"])
def test_what_is_no_human_has_no_roles_but_those_stated(text):
    skeleton = tree(text, ("_l$", "_r"))
    assert find_roles(skeleton) == {}
    assert (
        bones_of_role(skeleton, {}) == {}
        and bone_ends(skeleton, {}) == {}
        and role_lengths(skeleton, {}) == {}
    )
    name = skeleton.names[-1]
    assert find_roles(skeleton, {name: "head"}) == {"head": skeleton.n_joints - 1}


def test_what_the_user_states_wins():
    skeleton = tree(MIXAMO, ("Left", "Right"))
    guessed = find_roles(skeleton)
    roles = find_roles(skeleton, {"m:Spine1": "chest", "m:Spine2": "neck", "m:LeftLeg": "left_shin"})
    assert named(skeleton, roles) == {**named(skeleton, guessed), "chest": "m:Spine1", "neck": "m:Spine2"}
    assert tuple(roles) == ROLES


@pytest.mark.parametrize(("mapping", "message"), [
    ({"m:Spin": "chest"}, r"mapping names a joint 'm:Spin'; the skeleton has m:Spine"),
    ({"m:Spine": "belly"}, r"gives 'm:Spine' the role 'belly'; roles are hips, spine, chest, neck,"),
    ({"m:Spine": "chest", "m:Hips": "chest"}, r"'chest' to 'm:Spine' and to 'm:Hips'; one joint a role"),
])  # fmt: skip
def test_unknown_joints_and_roles_are_refused(mapping, message):
    with pytest.raises(ValueError, match=message):
        find_roles(tree(MIXAMO), mapping)


@pytest.mark.parametrize(("name", "side", "part"), [
    ("lfemur", "left", "thigh"), ("rradius", "right", "forearm"), ("lowerback", "", ""),
    ("LHipJoint", "left", "hip_joint"), ("LeftForeArmRoll", "left", ""),
    ("lForearmBend", "left", "forearm"), ("left_fore_upper", "left", ""),
    ("upperarm_twist_01_l", "left", ""), ("__Clavicle_L", "", ""), ("LeftHandIndex1", "left", "finger"),
    ("eyeball", "", ""), ("ik_foot_l", "left", ""), ("FootL", "left", "foot"), ("Armature", "", ""),
    ("", "", ""), ("HEAD", "", "head"), ("hind_thigh_l", "left", ""), ("toe1-1.L", "left", "toes"),
    ("metacarpal2.R", "right", "finger"),
])  # fmt: skip
def test_names_are_read_as_words(name, side, part):
    assert read_names((name,)) == [(side, part)]
