"""`tempose convert` takes motions too, and refuses what no file of that kind holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import tempose
from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip
from tempose.clips.resample import resample, select_frames
from tempose.kinematics import forward_kinematics
from tempose.rotations import from_rotation_vector


@pytest.fixture
def walk(tmp_path: Path, rng: np.random.Generator) -> SkeletonClip:
    skeleton = Skeleton(("hips", "chest", "head"), np.array([-1, 0, 1]), np.array([[0, 1.0, 0]] * 3))
    turns = np.cumsum(0.1 * rng.normal(size=(12, 3, 3)), axis=0)
    motion = SkeletonClip(skeleton, from_rotation_vector(turns), rng.normal(size=(12, 3)), 30.0)
    tempose.save(tmp_path / "walk.bvh", motion)
    return motion


def places(motion: SkeletonClip) -> np.ndarray:
    return forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)[1]


def test_motion_is_cut_and_resampled_as_the_library_does(run, tmp_path, walk) -> None:
    ran = run("convert", tmp_path / "walk.bvh", tmp_path / "b.bvh", "--start", 2, "--stop", 9, "--fps", 15)
    assert ran.code == 0, ran.err
    back = tempose.load(tmp_path / "b.bvh", up="y", unit=1.0)
    expected = resample(select_frames(walk, 2, 9), 15.0)
    assert back.fps == 15 and back.n_frames == expected.n_frames
    assert_allclose(places(back), places(expected), atol=1e-6)


def test_unit_of_the_motion_is_chosen(run, tmp_path, walk) -> None:
    assert run("convert", tmp_path / "walk.bvh", tmp_path / "b.bvh", "--unit", "cm").code == 0
    back = tempose.load(tmp_path / "b.bvh", up="y", unit=0.01)
    assert_allclose(places(back), places(walk), atol=1e-6)


def test_meshes_and_motions_are_not_mixed_up(run, tmp_path, walk, clip: MeshClip) -> None:
    ran = run("convert", tmp_path / "walk.bvh", tmp_path / "b.glb")
    assert ran.code == 2 and "goes into .bvh" in ran.err.splitlines()[-1]
    tempose.save(tmp_path / "clip.npz", clip)
    ran = run("convert", tmp_path / "clip.npz", tmp_path / "b.bvh")
    assert ran.code == 2 and "holds the motion of a skeleton" in ran.err.splitlines()[-1]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["clip.npz", "walk.bvh"]


def test_other_commands_write_no_bvh(run, tmp_path, walk) -> None:
    body = tmp_path / "body.obj"
    tempose.save(body, Mesh(np.eye(3), np.array([[0, 1, 2]])))
    assert (
        "cannot write '.bvh'" in run("transfer", tmp_path / "walk.bvh", body, "-o", tmp_path / "a.bvh").line
    )
