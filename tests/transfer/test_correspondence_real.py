"""Pairs by hand on real bodies: twenty picks do what painted weights do; thirty markers tell the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.rotations import angle_between, to_matrix
from tempose.transfer import (
    Pairs,
    PartnerFinder,
    Sections,
    add_pairs,
    align_meshes,
    check_coverage,
    complete_ring,
    find_symmetry,
    load_pairs,
    mirror_pairs,
    pairs_from_skin,
    skeleton_mesh,
    transfer_motion,
)
from tempose.transfer.correspondence.closest import spread_points

pytestmark = pytest.mark.real

Folder = Callable[[str], Path]


@pytest.fixture(scope="module")
def walk(data_folder: Folder) -> SkeletonClip:
    clip = load_skeleton_clip(data_folder("mocap-cmu") / "cmu_12_01_walk.bvh")
    return replace(clip.frames(np.r_[0, np.arange(1, clip.n_frames, 16)]), fps=clip.fps / 16)


@pytest.fixture(scope="module")
def body(data_folder: Folder) -> SkinnedMesh:
    folder = data_folder("makehuman-base")
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


@pytest.fixture(scope="module")
def horse(data_folder: Folder) -> Mesh:
    return load_mesh(data_folder("horse-camel-poses") / "horse_ref.obj")


@pytest.fixture(scope="module")
def camel(data_folder: Folder) -> Mesh:
    return load_mesh(data_folder("horse-camel-poses") / "camel_ref.obj")


@pytest.fixture(scope="module")
def markers(data_folder: Folder) -> Pairs:
    return load_pairs(data_folder("horse-camel-poses") / "horse_camel.cons")


RINGS = {"Hips": (0.5,), "LowerBack": (0.5,), "Spine1": (0.5,), "Neck": (0.5,)}
RINGS |= {limb: (0.27, 0.73) for limb in ("LeftArm", "LeftForeArm", "LeftUpLeg", "LeftLeg")}
RINGS |= {"Head": (0.3, 0.8), "LeftHand": (0.2, 0.7), "LeftFoot": (0.3, 0.8)}
SINGLE = {"LeftShoulder": (0.5,), "LeftToeBase": (0.6,)}


def pick(mesh: Mesh, known: Pairs, bone: str, share: float) -> int:
    """One triangle such as a person would click: of that bone, so far along it, on its front or top."""
    start, end = known.joints[bone], known.ends[bone]
    mine = known.target[[i for i, name in enumerate(known.source) if name == bone]]
    arm = mesh.vertices[mesh.faces[mine]].mean(axis=1) - start
    axis = (end - start) / np.linalg.norm(end - start)
    front = np.array([0.0, 1, 0] if "Foot" in bone or "Toe" in bone else [0.0, 0, 1])
    front = front - (front @ axis) * axis
    out = arm - (arm @ axis)[:, None] * axis
    facing = out @ front / (np.linalg.norm(out, axis=1) * np.linalg.norm(front))
    return int(mine[(8 * (arm @ axis / np.linalg.norm(end - start) - share) ** 2 - facing).argmin()])


def by_hand(mesh: Mesh, known: Pairs) -> tuple[Pairs, int]:
    sections = Sections(mesh.vertices, mesh.faces)
    pairs, picks = None, 0
    for bone, places in (RINGS | SINGLE).items():
        for share in places:
            face = pick(mesh, known, bone, share)
            pairs, picks = add_pairs(pairs, bone, [face]), picks + 1
            if bone in RINGS:
                ring = complete_ring(None, sections, (0, face))
                pairs = add_pairs(pairs, bone, ring.target[1:], how="ring")
    assert pairs is not None
    return pairs, picks


@pytest.mark.slow
def test_twenty_picks_do_what_weights_do(walk: SkeletonClip, body: SkinnedMesh) -> None:
    known = pairs_from_skin(walk.skeleton, body)
    pairs, picks = by_hand(body.mesh, known)
    assert picks <= 20
    both = mirror_pairs(pairs, body.mesh, walk.skeleton)
    assert both.warnings == () and both.added > 0.8 * len(pairs)
    assert [f for f in check_coverage(both.pairs, body.mesh, walk.skeleton) if f.severity != "note"] == []
    painted, clicked = (transfer_motion(walk, body.mesh, p) for p in (known, both.pairs))
    a, b = painted.report, clicked.report
    assert b["bone_direction_deg"]["mean"] < a["bone_direction_deg"]["mean"] + 1.5
    assert b["edge_ratio"][0] > a["edge_ratio"][0] - 0.03 and b["edge_ratio"][1] < a["edge_ratio"][1] + 0.03
    assert b["volume_worst"] > a["volume_worst"] - 1.5 and b["flipped_percent"] < 0.02
    V, W = (np.asarray(r.clip.vertices, dtype=np.float64) for r in (painted, clicked))
    gap = (V - V.mean(axis=1, keepdims=True)) - (W - W.mean(axis=1, keepdims=True))
    assert np.sqrt((gap**2).sum(axis=-1).mean()) < 0.025 * body.mesh.diagonal


@pytest.mark.slow
def test_thirty_markers_tell_the_others(horse: Mesh, camel: Mesh, markers: Pairs) -> None:
    source, target = np.asarray(markers.source), markers.target
    kept = spread_points(horse.vertices[source], 30, horse.vertices[source].mean(axis=0))
    others = np.setdiff1d(np.arange(len(source)), kept)
    known = Pairs("vertices", source[kept], target[kept])
    finder = PartnerFinder(horse, camel, known, kind="vertices")
    found = [finder.suggest(int(v)) for v in source[others]]
    best = np.array([c[0].index for c in found])
    off = np.linalg.norm(camel.vertices[best] - camel.vertices[target[others]], axis=1) / camel.diagonal
    assert np.median(off) < 0.02 and np.percentile(off, 90) < 0.06
    choice = [
        np.linalg.norm(camel.vertices[[c.index for c in row]] - camel.vertices[t], axis=1).min()
        for row, t in zip(found, target[others])
    ]
    assert np.median(choice) < 0.01 * camel.diagonal


@pytest.mark.slow
def test_rest_poses_are_laid_over_each_other(
    horse: Mesh, camel: Mesh, body: SkinnedMesh, walk: SkeletonClip
) -> None:
    still = np.array([1.0, 0, 0, 0])
    found = align_meshes(horse, camel)
    assert angle_between(found.rotation, still) < np.radians(20)
    assert 0.9 < found.scale < 1.3
    template = skeleton_mesh(walk.frames(slice(0, 1))).mesh
    found = align_meshes(template, body.mesh)
    assert angle_between(found.rotation, still) < np.radians(5)
    # centimetres, Z up
    V = body.mesh.vertices[:, [0, 2, 1]] * [100, -100, 100]
    back = align_meshes(body.mesh.with_vertices(V), body.mesh)
    assert np.abs(to_matrix(back.rotation) @ [0, 0, 1] - [0, 1, 0]).max() < 0.02
    assert abs(100 * back.scale - 1) < 0.01


@pytest.mark.slow
def test_real_bodies_have_their_plane(horse: Mesh, camel: Mesh, body: SkinnedMesh) -> None:
    for mesh in (horse, camel, body.mesh):
        found = find_symmetry(mesh)
        assert abs(found.normal[0]) > 0.999 and found.residual < 0.005


@pytest.mark.slow
def test_given_markers_pass_the_checks(horse: Mesh, camel: Mesh, markers: Pairs) -> None:
    found = check_coverage(markers, camel, horse)
    assert not any(f.severity == "error" for f in found) and len(found) <= 3
    crossed = np.array(markers.source)
    crossed[[3, 40]] = crossed[[40, 3]]
    named = [f.pairs[0] for f in check_coverage(replace(markers, source=crossed), camel, horse) if f.pairs]
    assert set(named[:2]) == {3, 40}
