"""Skeletons of 22, 31 and 75 joints with their makers' names drive the same body to the same places."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from transfer_bodies import human_body, scaled, t_pose

from tempose.clips import Skeleton, SkeletonClip
from tempose.samples.walk import walk
from tempose.transfer import TransferResult, pairs_from_skin, transfer_motion

BANDAI = {
    "hips": "Hips", "spine": "Spine", "chest": "Chest", "neck": "Neck", "head": "Head",
    "clavicle": "Shoulder_{}", "upper_arm": "UpperArm_{}", "forearm": "LowerArm_{}", "hand": "Hand_{}",
    "thigh": "UpperLeg_{}", "shin": "LowerLeg_{}", "foot": "Foot_{}", "toes": "Toes_{}",
}  # fmt: skip
CMU = {
    "hips": "root", "spine": "lowerback", "chest": "thorax", "neck": "lowerneck", "head": "head",
    "clavicle": "{}clavicle", "upper_arm": "{}humerus", "forearm": "{}radius", "hand": "{}wrist",
    "thigh": "{}femur", "shin": "{}tibia", "foot": "{}foot", "toes": "{}toes",
}  # fmt: skip
MIXAMO = {
    "hips": "mixamorig:Hips", "spine": "mixamorig:Spine", "chest": "mixamorig:Spine2",
    "neck": "mixamorig:Neck", "head": "mixamorig:Head",
    "clavicle": "mixamorig:{}Shoulder", "upper_arm": "mixamorig:{}Arm", "forearm": "mixamorig:{}ForeArm",
    "hand": "mixamorig:{}Hand", "thigh": "mixamorig:{}UpLeg", "shin": "mixamorig:{}Leg",
    "foot": "mixamorig:{}Foot", "toes": "mixamorig:{}ToeBase",
}  # fmt: skip
MAKEHUMAN = {
    "hips": "root", "spine": "spine05", "chest": "spine01", "neck": "neck01", "head": "head",
    "clavicle": "clavicle.{}", "upper_arm": "upperarm01.{}", "forearm": "lowerarm01.{}", "hand": "wrist.{}",
    "thigh": "upperleg01.{}", "shin": "lowerleg01.{}", "foot": "foot.{}", "toes": "toe1-1.{}",
}  # fmt: skip
SIDES = {"bandai": ("L", "R"), "cmu": ("l", "r"), "mixamo": ("Left", "Right"), "makehuman": ("L", "R")}
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Pinky")


@lru_cache
def walking() -> SkeletonClip:
    motion = walk(t_pose(), duration=0.5, fps=20.0)
    return motion.frames(slice(0, 10))


@lru_cache
def walked() -> TransferResult:
    return transfer_motion(walking(), human_body())


def named(clip: SkeletonClip, table: dict[str, str], sides: tuple[str, str]) -> SkeletonClip:
    """The same joints under another maker's names."""

    def name(role: str) -> str:
        side, _, part = role.partition("_")
        if part and side in ("left", "right"):
            return table[part].format(sides[side == "right"])
        return table[role]

    s = clip.skeleton
    names = tuple(name(role) for role in s.names)
    return replace(clip, skeleton=Skeleton(names, s.parents, s.offsets, s.rest_rotations, s.tips))


def with_joints(clip: SkeletonClip, added: list[tuple[str, str, np.ndarray]]) -> SkeletonClip:
    """More joints: name, name of the joint above, offset from it; they rest."""
    s = clip.skeleton
    names, parents, offsets = list(s.names), list(map(int, s.parents)), list(map(np.asarray, s.offsets))
    for name, above, offset in added:
        parents.append(names.index(above))
        names.append(name)
        offsets.append(offset)
    k = len(added)
    still = np.tile([1.0, 0, 0, 0], (clip.n_frames, k, 1))
    tips = np.concatenate([s.tips, np.full((k, 3), np.nan)])
    rest = np.concatenate([s.rest_rotations, np.tile([1.0, 0, 0, 0], (k, 1))])
    skeleton = Skeleton(tuple(names), parents, np.array(offsets), rest, tips)
    return replace(clip, skeleton=skeleton, rotations=np.concatenate([clip.rotations, still], axis=1))


def fingers(hand: str, pattern: str, x: float) -> list[tuple[str, str, np.ndarray]]:
    """Five fingers of four joints, straight on from a hand that points along x."""
    added = []
    for f, finger in enumerate(FINGERS):
        above = hand
        for k in range(1, 5):
            name = pattern.format(finger, k)
            added.append((name, above, np.array([0.03 * x, 0.0, 0.01 * (f - 2) if k == 1 else 0.0])))
            above = name
    return added


def bandai() -> SkeletonClip:
    clip = named(walking(), BANDAI, SIDES["bandai"])
    return with_joints(clip, [("joint_Root", "Hips", np.zeros(3))])


def cmu() -> SkeletonClip:
    clip = named(walking(), CMU, SIDES["cmu"])
    more = [("upperneck", "head", np.zeros(3))]
    for side, x in (("l", 1.0), ("r", -1.0)):
        more += [
            (f"{side}hand", f"{side}wrist", np.array([0.05 * x, 0, 0])),
            (f"{side}fingers", f"{side}hand", np.array([0.05 * x, 0, 0])),
            (f"{side}thumb", f"{side}wrist", np.array([0.02 * x, 0, 0.02])),
        ]
    more += [(f"extra{k}", "head", np.array([0.0, 0.02, 0.05])) for k in range(3)]
    return with_joints(clip, more)


def mixamo() -> SkeletonClip:
    clip = named(walking(), MIXAMO, SIDES["mixamo"])
    more = []
    for side, x in (("Left", 1.0), ("Right", -1.0)):
        more += fingers(f"mixamorig:{side}Hand", f"mixamorig:{side}Hand{{}}{{}}", x)
        more += [(f"mixamorig:{side}Toe_End", f"mixamorig:{side}ToeBase", np.array([0.0, 0, 0.05]))]
    more += [("mixamorig:HeadTop_End", "mixamorig:Head", np.array([0.0, 0.2, 0]))]
    more += [(f"mixamorig:Face{k}", "mixamorig:Head", np.array([0.01 * k, 0.05, 0.1])) for k in range(11)]
    return with_joints(clip, more)


def makehuman() -> SkeletonClip:
    clip = named(walking(), MAKEHUMAN, SIDES["makehuman"])
    more = []
    for side, x in (("L", 1.0), ("R", -1.0)):
        for f in range(1, 6):
            above = f"wrist.{side}"
            for k in range(1, 4):
                more.append((f"finger{f}-{k}.{side}", above, np.array([0.03 * x, 0, 0.01 * (f - 3)])))
                above = f"finger{f}-{k}.{side}"
        more += [(f"toe{f}-1.{side}", f"foot.{side}", np.array([0.01 * f, -0.02, 0.1])) for f in range(2, 6)]
    more += [(f"{name}", "head", np.array([0.0, 0.02, 0.08])) for name in ("jaw", "eye.L", "eye.R")]
    more += [(f"orbicularis{k:02d}", "head", np.array([0.0, 0.03, 0.08])) for k in range(13)]
    return with_joints(clip, more)


SOURCES = {"bandai 22": bandai, "cmu 31": cmu, "mixamo 75": mixamo, "makehuman 75": makehuman}


@pytest.mark.parametrize("name", SOURCES)
def test_a_skeleton_of_any_maker_moves_the_body_alike(name: str) -> None:
    clip = SOURCES[name]()
    assert clip.skeleton.n_joints == int(name.split()[1])
    result = transfer_motion(clip, human_body())
    apart = np.asarray(result.clip.vertices, dtype=float) - walked().clip.vertices
    assert np.abs(apart).max() < 1e-3 * human_body().mesh.height
    assert result.report["warnings"] == []
    assert result.report["bone_direction_deg"]["mean"] == pytest.approx(
        walked().report["bone_direction_deg"]["mean"], abs=0.5
    )
    parts = dict(zip(result.pairs.source, result.pairs.parts))
    assert set(parts.values()) == set(walked().pairs.parts)


@pytest.mark.parametrize("unit", [0.2, 5.0])
def test_a_giant_and_a_dwarf_walk_the_same_body_alike(unit: float) -> None:
    result = transfer_motion(scaled(walking(), unit), human_body(), measure=False)
    assert_allclose(result.clip.vertices, walked().clip.vertices, rtol=0, atol=1e-4)
    small = replace(human_body(), mesh=human_body().mesh.with_vertices(unit * human_body().mesh.vertices))
    pairs = pairs_from_skin(walking().skeleton, human_body())
    places = [{k: unit * p for k, p in d.items()} for d in (pairs.joints, pairs.ends)]
    moved = transfer_motion(
        walking(), small.mesh, replace(pairs, joints=places[0], ends=places[1]), measure=False
    )
    assert_allclose(moved.clip.vertices / unit, walked().clip.vertices, rtol=0, atol=1e-4)


def test_nonsense_names_need_a_mapping_and_work_with_one() -> None:
    clip = mixamo()
    s = clip.skeleton
    blank = tuple(f"bone_{k:03d}" for k in range(s.n_joints))
    odd = replace(clip, skeleton=Skeleton(blank, s.parents, s.offsets, s.rest_rotations, s.tips))
    with pytest.raises(ValueError, match="mapping"):
        transfer_motion(odd, human_body(), measure=False)
    with pytest.raises(ValueError, match="name them with a mapping"):
        transfer_motion(odd, human_body().mesh, measure=False)
    roles = walking().skeleton.names
    mapping = {blank[k]: role for k, role in enumerate(roles)}
    result = transfer_motion(odd, human_body(), mapping=mapping, measure=False)
    plain = transfer_motion(clip, human_body(), measure=False)
    assert_allclose(result.clip.vertices, plain.clip.vertices, rtol=0, atol=1e-6)
