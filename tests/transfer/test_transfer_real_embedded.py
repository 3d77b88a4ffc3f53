"""Real bodies without pairs and weights: people are moved, animals are refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tempose.clips import Mesh, SkeletonClip
from tempose.formats import load_mesh, load_skeleton_clip
from tempose.transfer import find_pairs, transfer_motion

pytestmark = [pytest.mark.real, pytest.mark.slow]

Folder = Callable[[str], Path]


@pytest.fixture(scope="module")
def running(data_folder: Folder) -> SkeletonClip:
    clip = load_skeleton_clip(data_folder("mocap-cmu") / "02_03.amc")
    return replace(clip.frames(np.arange(0, clip.n_frames, 8)), fps=clip.fps / 8)


def makehuman(data_folder: Folder) -> Mesh:
    return load_mesh(data_folder("makehuman-base") / "base.obj", group="body")


def dressed(data_folder: Folder) -> Mesh:
    """MakeHuman with eyes, teeth, hair, tights, a skirt to the feet and the cubes that mark its joints."""
    return load_mesh(data_folder("makehuman-base") / "base.obj")


def mannequin(data_folder: Folder) -> Mesh:
    return load_mesh(data_folder("rigged-gltf") / "human-male.glb")


def crane(data_folder: Folder) -> Mesh:
    return load_mesh(data_folder("vlasic-crane") / "mesh_0000.obj")


@pytest.mark.parametrize(("body", "direction"), [(makehuman, 4), (mannequin, 5), (crane, 7)])
def test_a_person_runs_without_a_click(
    data_folder: Folder, running: SkeletonClip, body: Callable[[Folder], Mesh], direction: float
) -> None:
    report = transfer_motion(running, body(data_folder)).report
    assert report["embedding"]["penalty"] < 0.9
    assert report["warnings"] == []
    assert report["bone_direction_deg"]["mean"] < direction
    assert report["flipped_percent"] < 0.01 and report["folded_percent"] < 0.05
    assert report["quaternion_norm_min"] > 0.8
    assert report["edge_ratio"][0] > 0.65 and report["edge_ratio"][1] < 1.4


def test_eyes_and_teeth_stay_in_the_head(data_folder: Folder, running: SkeletonClip) -> None:
    mesh = dressed(data_folder)
    V = np.asarray(transfer_motion(running, mesh, measure=False).clip.vertices, dtype=np.float64)
    body = np.unique(mesh.faces[mesh.groups["body"]])
    for name in ("helper-l-eye", "helper-r-eye", "helper-upper-teeth", "helper-lower-teeth", "helper-tongue"):
        part = np.unique(mesh.faces[mesh.groups[name]])
        centre = mesh.vertices[part].mean(axis=0)
        near = body[np.argsort(np.linalg.norm(mesh.vertices[body] - centre, axis=1))[:60]]
        rest = mesh.vertices[near] - mesh.vertices[near].mean(axis=0)
        for frame in V:
            middle = frame[near].mean(axis=0)
            U, _, Vt = np.linalg.svd(rest.T @ (frame[near] - middle))
            R = Vt.T @ np.diag([1, 1, np.sign(np.linalg.det(Vt.T @ U.T))]) @ U.T
            expected = middle + R @ (centre - mesh.vertices[near].mean(axis=0))
            assert np.linalg.norm(expected - frame[part].mean(axis=0)) < 0.004, name


@pytest.mark.parametrize(
    ("folder", "name"),
    [
        ("horse-camel-poses", "horse_ref.obj"),
        ("horse-camel-poses", "camel_ref.obj"),
        ("rigged-gltf", "Fox.glb"),
    ],
)
def test_an_animal_is_refused(data_folder: Folder, running: SkeletonClip, folder: str, name: str) -> None:
    with pytest.raises(ValueError, match=r"does not look human: .*penalty"):
        find_pairs(running.skeleton, load_mesh(data_folder(folder) / name))
