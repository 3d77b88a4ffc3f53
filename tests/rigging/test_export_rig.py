"""A rig that goes out as a file is the rig that comes in again; what a format cannot hold is measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from rig_bodies import human_skin, random_rig

from tempose import formats
from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.rigging import Rig
from tempose.rigging.export import export_rig
from tempose.rigging.few_weights import few_weights
from tempose.rotations import from_rotation_vector, multiply

RIG = random_rig(human_skin(), frames=6, size=0.4)


def crowded(joints: int = 7, seed: int = 0) -> Rig:
    """The rig with more weights a vertex than a GLB holds, spread over joints near one another."""
    rng = np.random.default_rng(seed)
    skeleton = RIG.skin.skeleton
    near = np.eye(skeleton.n_joints) + 0.3 * np.array(
        [
            [float(p == k or q == j) for k, q in enumerate(skeleton.parents)]
            for j, p in enumerate(skeleton.parents)
        ]
    )
    W = RIG.skin.weights @ near @ near
    W *= rng.uniform(0.5, 1.5, W.shape)
    order = np.argsort(-W, axis=1)
    np.put_along_axis(W, order[:, joints:], 0.0, axis=1)
    return Rig(SkinnedMesh(RIG.skin.mesh, skeleton, W / W.sum(axis=1, keepdims=True)), RIG.motion)


def largest_four(skin: SkinnedMesh) -> SkinnedMesh:
    W = np.array(skin.weights)
    np.put_along_axis(W, np.argsort(-W, axis=1)[:, 4:], 0.0, axis=1)
    return replace(skin, weights=W / W.sum(axis=1, keepdims=True))


def rms(skin: SkinnedMesh, rig: Rig, motion: SkeletonClip) -> float:
    off = Rig(skin, motion).vertices() - rig.vertices(motion)
    return float(np.sqrt((off**2).sum(axis=2).mean()))


@pytest.mark.parametrize("ending", ["glb", "usda"])
def test_frames_in_the_file_are_those_of_the_rig(tmp_path, ending):
    if ending == "usda":
        pytest.importorskip("pxr")
    done = export_rig(RIG, tmp_path / f"a.{ending}")
    clip = formats.load_clip(tmp_path / f"a.{ending}")
    assert np.abs(clip.vertices - RIG.vertices()).max() < 1e-5 * RIG.skin.mesh.diagonal
    assert done.frames == 6 and done.largest_percent == 0 and not done.warnings


def test_another_motion_goes_out_and_its_joints_are_checked(tmp_path):
    export_rig(RIG, tmp_path / "a.bvh", motion=RIG.motion.frames(slice(0, 2)))
    assert formats.load_skeleton_clip(tmp_path / "a.bvh").n_frames == 2
    skeleton = replace(RIG.skin.skeleton, names=tuple(f"x{j}" for j in range(RIG.skin.skeleton.n_joints)))
    with pytest.raises(ValueError, match="match_motion puts another one"):
        export_rig(RIG, tmp_path / "b.bvh", motion=replace(RIG.motion, skeleton=skeleton))
    with pytest.raises(formats.FormatError, match=r"a rig goes into \.bvh, \.glb"):
        export_rig(RIG, tmp_path / "b.obj")


def test_what_four_weights_cost_is_said(tmp_path):
    rig = crowded()
    done = export_rig(rig, tmp_path / "a.glb")
    clip = formats.load_clip(tmp_path / "a.glb")
    off = np.linalg.norm(clip.vertices - rig.vertices(), axis=2).max()
    assert abs(done.largest_percent - 100 * off / rig.skin.mesh.diagonal) < 1e-3
    assert "more than four joints" in done.warnings[0] and "% of the size" in done.warnings[-1]


def test_dual_quaternions_are_lost_in_a_glb_with_a_warning(tmp_path):
    rig = Rig(RIG.skin, RIG.motion, "dual-quaternion")
    done = export_rig(rig, tmp_path / "a.glb")
    assert any("dual quaternions" in line for line in done.warnings) and done.largest_percent > 0


def test_few_weights_are_convex_and_better_than_the_largest_also_after_an_edit():
    rig = crowded()
    skin = few_weights(rig.skin, rig.motion)
    assert np.count_nonzero(skin.weights, axis=1).max() <= 4
    assert skin.weights.min() >= 0
    assert_allclose(skin.weights.sum(axis=1), 1)
    assert rms(skin, rig, rig.motion) < 0.9 * rms(largest_four(rig.skin), rig, rig.motion)
    rotations = np.array(rig.motion.rotations)
    arm = rig.skin.skeleton.index("left_upper_arm")
    rotations[:, arm] = multiply(rotations[:, arm], from_rotation_vector(np.array([0.5, 0.9, 0])))
    edited = replace(rig.motion, rotations=rotations)
    assert rms(skin, rig, edited) < 1.05 * rms(largest_four(rig.skin), rig, edited)


def test_skins_of_few_weights_stay_as_they_are():
    assert few_weights(RIG.skin, RIG.motion) is RIG.skin
    rig = crowded()
    mixed = np.where(np.arange(len(rig.skin.weights))[:, None] % 2, rig.skin.weights, RIG.skin.weights)
    skin = few_weights(replace(rig.skin, weights=mixed), rig.motion)
    assert_array_equal(skin.weights[::2], RIG.skin.weights[::2])
