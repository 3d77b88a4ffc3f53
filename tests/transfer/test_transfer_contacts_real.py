"""Real walks, runs and jumps: feet that neither skate, nor sink, nor pop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.formats import load_clip, load_mesh, load_skeleton_clip, load_skin
from tempose.transfer import load_pairs, transfer_motion

pytestmark = pytest.mark.real

Folder = Callable[[str], Path]


@pytest.fixture(scope="module")
def makehuman(data_folder: Folder) -> SkinnedMesh:
    folder = data_folder("makehuman-base")
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


@pytest.fixture(scope="module")
def mannequin(data_folder: Folder) -> SkinnedMesh:
    return load_skin(data_folder("rigged-gltf") / "human-male.glb")


def every(clip: SkeletonClip, step: int, stop: int) -> SkeletonClip:
    frames = np.r_[0, np.arange(1, min(stop, clip.n_frames), step)]
    return replace(clip.frames(frames), fps=clip.fps / step)


def planted(clip: SkeletonClip, target: SkinnedMesh) -> None:
    report = transfer_motion(clip, target).report
    assert report["skate"] < 0.05 < report["source_skate"]
    assert report["penetration_cm"] < 0.01
    assert report["foot_acceleration"]["rms"] < 1.2 and report["foot_acceleration"]["p99"] < 1.2
    assert report["warnings"] == []
    for foot in report["contacts"].values():
        assert foot["frames"] > 3 and foot["unmet_cm"] < 0.1 and foot["stretch"] < 1.06


@pytest.mark.parametrize("name", ["cmu_12_01_walk.bvh", "02_03.amc", "02_04.amc"])
def test_feet_are_planted_on_the_mannequin(data_folder: Folder, mannequin: SkinnedMesh, name: str) -> None:
    planted(every(load_skeleton_clip(data_folder("mocap-cmu") / name), 4, 260), mannequin)


@pytest.mark.slow
def test_feet_are_planted_on_makehuman_at_full_rate(data_folder: Folder, makehuman: SkinnedMesh) -> None:
    planted(load_skeleton_clip(data_folder("mocap-cmu") / "02_03.amc"), makehuman)


def test_a_gallop_on_the_spot_has_no_contact_to_hold(data_folder: Folder) -> None:
    folder = data_folder("horse-camel-poses")
    gallop = load_clip(data_folder("horse-gallop"), fps=24)
    camel = load_mesh(folder / "camel_ref.obj")
    rest = load_mesh(folder / "horse_ref.obj")
    pairs = load_pairs(folder / "horse_camel.cons")
    few = replace(gallop, vertices=gallop.vertices[:6])
    report = transfer_motion(few, camel, pairs, source_rest=rest).report
    assert len(report["contacts"]) >= 4
    assert all(foot["intervals"] == [] and foot["stretch"] is None for foot in report["contacts"].values())
    assert report["skate"] is None and report["foot_acceleration"]["p99"] < 1.5
