"""Real clips: turns that made them come back to a tenth of a degree, and no frame of a capture is lost."""

from __future__ import annotations

import numpy as np
import pytest

from tempose import formats
from tempose.kinematics import bone_transforms
from tempose.kinematics.skinning import bake
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.refine import refine_joints
from tempose.rigging.skeletons.human import human_skin
from tempose.rotations import angle_between

pytestmark = pytest.mark.real


def test_a_walk_baked_to_frames_gives_its_joint_angles_back(data_folder) -> None:
    path = data_folder("rigged-gltf") / "CesiumMan.glb"
    skin, motion = formats.load_skin(path), formats.load_skeleton_clip(path)
    fit = fit_poses(skin, bake(skin, motion), skeleton=motion.skeleton)
    turns = [
        bone_transforms(skin.skeleton, m.rotations, m.root_position, m.skeleton)[0]
        for m in (fit.motion, motion)
    ]
    assert np.degrees(angle_between(*turns)).max() < 0.1
    assert fit.converged.all()


def test_frames_baked_by_another_program_give_their_joint_angles_back(data_folder) -> None:
    pytest.importorskip("pxr")
    folder = data_folder("usd-skel")
    skin, motion = formats.load_skin(folder / "lbs.usda"), formats.load_skeleton_clip(folder / "lbs.usda")
    baked = formats.load_clip(folder / "lbs.baked.usda")
    fit = fit_poses(skin, baked.vertices, skeleton=motion.skeleton)
    assert np.degrees(angle_between(fit.motion.rotations, motion.rotations)).max() < 0.1


@pytest.mark.slow
def test_no_frame_of_a_dressed_dancer_is_lost(data_folder) -> None:
    clip = formats.load_clip(data_folder("vlasic-crane"))
    skin = human_skin(clip.mesh.with_vertices(np.asarray(clip.vertices[10], dtype=np.float64))).skin
    D = skin.mesh.diagonal
    fit = fit_poses(skin, clip.vertices)
    assert fit.converged.all() and fit.errors.max() < 0.016 * D
    found = refine_joints(skin, fit.motion, clip.vertices)
    assert found.rms[0] < 0.0105 * D and found.rms[-1] < 0.9 * found.rms[0]
    # 2.3 and more where arms are lost after frame 110
    assert found.fit.errors.max() < 0.014 * D
    hands = [skin.skeleton.index(f"{side}_hand") for side in ("left", "right")]
    for hand in hands:
        q = found.fit.motion.rotations[:, hand]
        assert ((q[1:] * q[:-1]).sum(axis=1) > 0.7).all()
