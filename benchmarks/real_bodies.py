"""Real motions and bodies by short names, for the results scripts.

Real clips are found through TEMPOSE_DATA, else beside the checkout.
"""

from __future__ import annotations

import os
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.samples import human_character

ROOT = Path(__file__).resolve().parents[1]
DATA = Path(os.environ.get("TEMPOSE_DATA") or ROOT.parent / "shared" / "data")

MOTIONS = {
    "walk": ("mocap-cmu/cmu_12_01_walk.bvh", 4),
    "run": ("mocap-cmu/02_03.amc", 4),
    "jump": ("mocap-cmu/02_04.amc", 4),
    "bandai-run": ("mocap-bandai-namco/dataset-1_run_normal_001.bvh", 1),
    "bandai-walk": ("mocap-bandai-namco/dataset-1_walk_normal_001.bvh", 1),
}
BANDAI_REST = "mocap-bandai-namco/dataset-1_bow_normal_001.bvh"


def motion(name: str) -> SkeletonClip:
    path, step = MOTIONS[name]
    clip = load_skeleton_clip(DATA / path)
    if step == 1:
        return clip
    # frame 0 is kept whatever the step: in the converted CMU files it is the T-pose
    frames = np.r_[0, np.arange(1, clip.n_frames, step)]
    return replace(clip.frames(frames), fps=clip.fps / step)


def reference_of(name: str) -> dict[str, object]:
    """What `transfer_motion` needs to know of the reference pose of a motion."""
    if not name.startswith("bandai"):
        return {}
    return {"source_rest": load_skeleton_clip(DATA / BANDAI_REST), "rest_frame": 0}


@cache
def person(name: str) -> SkinnedMesh:
    """Return a human with skin weights."""
    if name == "human-male":
        return load_skin(DATA / "rigged-gltf" / "human-male.glb")
    if name == "sample-human":
        return human_character(20_000).skin
    folder = DATA / "makehuman-base"
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


@cache
def bare_person(name: str) -> Mesh:
    """Return a human as a mesh, without weights."""
    if name == "crane":
        return load_mesh(DATA / "vlasic-crane" / "mesh_0000.obj")
    return person(name).mesh
