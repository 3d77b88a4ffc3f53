"""Walk, run and jump onto the MakeHuman body: every bound of the quality table, volume held or not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.transfer import transfer_motion

pytestmark = [pytest.mark.real, pytest.mark.slow]

CLIPS = {"walk": "cmu_12_01_walk.bvh", "run": "02_03.amc", "jump": "02_04.amc"}
# direction mean and worst, edges p1 and p99, volume at worst, shortest quaternion
BOUNDS = {
    ("walk", 0.0): (3, 7, 0.85, 1.15, -5, 0.9),
    ("run", 0.0): (5, 9, 0.80, 1.20, -6, 0.85),
    ("jump", 0.0): (5, 9, 0.80, 1.20, -15, 0.85),
    ("walk", 1.0): (3, 7, 0.83, 1.20, -1.5, 0.9),
    ("run", 1.0): (5, 9, 0.75, 1.25, -2, 0.85),
    ("jump", 1.0): (5, 9, 0.78, 1.25, -4, 0.85),
}


@pytest.fixture(scope="module")
def report_of(data_folder: Callable[[str], Path]):
    body = data_folder("makehuman-base")
    skin = load_skin(body / "default_weights.mhw", mesh=load_mesh(body / "base.obj", group="body"))

    @cache
    def report(name: str, volume: float) -> dict:
        clip = load_skeleton_clip(data_folder("mocap-cmu") / CLIPS[name])
        clip = replace(clip.frames(np.r_[0, np.arange(1, clip.n_frames, 4)]), fps=clip.fps / 4)
        return transfer_motion(clip, skin, volume=volume).report

    return report


@pytest.mark.parametrize(("name", "volume"), BOUNDS)
def test_every_cell_of_the_table_is_reached(report_of, name: str, volume: float) -> None:
    report = report_of(name, volume)
    mean, worst, low, high, lost, short = BOUNDS[name, volume]
    angle = report["bone_direction_deg"]
    assert angle["mean"] < mean and angle["max"] < worst
    assert report["edge_ratio"][0] >= low - 0.0005 and report["edge_ratio"][1] <= high
    assert report["volume_worst"] > lost
    assert report["quaternion_norm_min"] > short
    assert report["flipped_percent"] == 0
    # what is folded is the web of the smallest toes, folded at rest already
    assert report["folded_percent"] < 0.01


@pytest.mark.parametrize("name", CLIPS)
def test_every_joint_keeps_its_volume_when_asked_to(report_of, name: str) -> None:
    joints = report_of(name, 1.0)["joint_volume"]
    assert len(joints) == 10
    assert max(abs(found["worst"]) for found in joints.values()) < 4
