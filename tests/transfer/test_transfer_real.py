"""Real clips onto real bodies: the bounds a good transfer keeps, and identities that hold on any data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from transfer_bodies import about, scaled, turned
from transfer_zoo import centred

from tempose.clips import MeshClip, SkeletonClip, SkinnedMesh
from tempose.formats import load_clip, load_mesh, load_skeleton_clip, load_skin
from tempose.kinematics.roles import find_roles
from tempose.metrics import compare
from tempose.transfer import Pairs, TransferResult, load_pairs, pairs_from_skin, transfer_motion
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.turns.reference import bone_rest, choose_reference

pytestmark = pytest.mark.real

Folder = Callable[[str], Path]


def every(clip: SkeletonClip, step: int, first: int = 1) -> SkeletonClip:
    """Frame 0 and every so many after it: in the converted CMU files frame 0 is a T-pose."""
    frames = np.r_[0, np.arange(first, clip.n_frames, step)]
    return replace(clip.frames(frames), fps=clip.fps / step)


@pytest.fixture(scope="module")
def cmu_walk(data_folder: Folder) -> SkeletonClip:
    return every(load_skeleton_clip(data_folder("mocap-cmu") / "cmu_12_01_walk.bvh"), 12)


@pytest.fixture(scope="module")
def makehuman(data_folder: Folder) -> SkinnedMesh:
    folder = data_folder("makehuman-base")
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


@pytest.fixture(scope="module")
def mannequin(data_folder: Folder) -> SkinnedMesh:
    return load_skin(data_folder("rigged-gltf") / "human-male.glb")


@pytest.fixture(scope="module")
def walked(cmu_walk: SkeletonClip, makehuman: SkinnedMesh) -> TransferResult:
    return transfer_motion(cmu_walk, makehuman)


def doubles(result: TransferResult) -> np.ndarray:
    return np.asarray(result.clip.vertices, dtype=np.float64)


def fine(result: TransferResult, direction: float, volume: float, quaternion: float, edges: float) -> None:
    report = result.report
    assert report["bone_direction_deg"]["mean"] < direction
    assert report["flipped_percent"] < 0.01
    assert report["folded_percent"] < 0.05
    assert report["volume_worst"] > volume
    assert report["quaternion_norm_min"] > quaternion
    assert 1 / report["edge_ratio"][0] < edges and report["edge_ratio"][1] < edges
    assert report["warnings"] == []


def test_a_cmu_walk_moves_the_makehuman_body(walked: TransferResult, cmu_walk: SkeletonClip) -> None:
    fine(walked, direction=4, volume=-8, quaternion=0.85, edges=1.25)
    assert walked.clip.n_frames == cmu_walk.n_frames - walked.report["first_frame"]
    assert walked.report["skate"] < walked.report["source_skate"]
    # the walker covers ground: several body heights
    travel = np.ptp(doubles(walked).mean(axis=1), axis=0)
    assert travel[[0, 2]].max() > 2 * walked.clip.mesh.height


@pytest.mark.parametrize("step", [1, 2, 4])
def test_the_t_pose_before_a_cmu_walk_is_found_and_dropped(step: int, data_folder: Folder) -> None:
    clip = every(load_skeleton_clip(data_folder("mocap-cmu") / "cmu_12_01_walk.bvh"), step)
    roles = find_roles(clip.skeleton)
    bones = make_bones(clip.skeleton, tuple(clip.skeleton.names[j] for j in roles.values()), roles)
    found = choose_reference(clip, bones, roles, bone_rest(clip, bones, roles))
    assert found.first_frame == 1 and found.upright
    # a T-pose: arms level and out to the sides
    for side, x in (("left", 1.0), ("right", -1.0)):
        arm = found.pose.directions[bones.roles.index(f"{side}_forearm")]
        assert arm @ [x, 0, 0] > 0.95


def test_makehuman_rests_when_the_source_stands_as_it_does(
    makehuman: SkinnedMesh, cmu_walk: SkeletonClip
) -> None:
    pairs = pairs_from_skin(cmu_walk.skeleton, makehuman)
    solver = prepare_skeleton(cmu_walk.frames(slice(0, 3)), makehuman.mesh, pairs).solver
    rest = solver.pose(np.tile([1.0, 0, 0, 0], (solver.n_bones, 1)))
    assert_allclose(rest, makehuman.mesh.vertices, rtol=0, atol=1e-9 * makehuman.mesh.diagonal)
    assert solver.basis.min() > -1e-9 and solver.basis.max() < 1 + 1e-9


def test_a_turned_walk_in_another_unit_is_the_turned_walk(
    walked: TransferResult, cmu_walk: SkeletonClip, makehuman: SkinnedMesh
) -> None:
    other = transfer_motion(turned(scaled(cmu_walk, 100.0), about("y", 90)), makehuman)
    R = np.array([[0, 0, 1.0], [0, 1, 0], [-1, 0, 0]])
    D = makehuman.mesh.diagonal
    moved, expected = doubles(other), doubles(walked) @ R.T
    shift = (moved - expected).mean(axis=(0, 1))
    assert_allclose(moved, expected + shift, rtol=0, atol=1e-5 * D)
    assert other.report["bone_direction_deg"]["mean"] == pytest.approx(
        walked.report["bone_direction_deg"]["mean"], abs=1e-3
    )
    assert other.report["skate"] == pytest.approx(walked.report["skate"], abs=1e-3)


def test_a_cmu_walk_moves_a_jointed_mannequin(cmu_walk: SkeletonClip, mannequin: SkinnedMesh) -> None:
    """Of 61 pieces, most without a mark: links keep them together."""
    result = transfer_motion(cmu_walk, mannequin)
    fine(result, direction=4, volume=-8, quaternion=0.85, edges=1.4)
    assert result.report["links"] > 60
    rest, V = mannequin.mesh.vertices, doubles(result)
    solver = prepare_skeleton(cmu_walk, mannequin.mesh, pairs_from_skin(cmu_walk.skeleton, mannequin)).solver
    first = np.unique(solver._inverse, return_index=True)[1]
    i, j = first[solver.links.pairs].T
    gaps = np.linalg.norm(V[:, i] - V[:, j], axis=2) - np.linalg.norm(rest[i] - rest[j], axis=1)
    assert np.abs(gaps).max() < 0.01 * mannequin.mesh.diagonal


@pytest.mark.parametrize(
    ("name", "direction", "quaternion"),
    [("run", 5, 0.85), ("kick", 6, 0.6), ("dash", 6, 0.6)],
)
def test_bandai_clips_move_the_makehuman_body(
    name: str, direction: float, quaternion: float, data_folder: Folder, makehuman: SkinnedMesh
) -> None:
    """Their rest is no pose at all; a standing frame of another clip of the same actor is the reference."""
    folder = data_folder("mocap-bandai-namco")
    (path,) = folder.glob(f"dataset-1_{name}_*_001.bvh")
    clip = load_skeleton_clip(path)
    step = max(1, clip.n_frames // 16)
    rest = load_skeleton_clip(folder / "dataset-1_bow_normal_001.bvh")
    short = replace(clip.frames(slice(None, None, step)))
    result = transfer_motion(short, makehuman, source_rest=rest, rest_frame=0)
    fine(result, direction=direction, volume=-20, quaternion=quaternion, edges=1.4)


@pytest.fixture(scope="module")
def gallop(data_folder: Folder) -> MeshClip:
    clip = load_clip(data_folder("horse-gallop"), fps=24)
    return MeshClip(clip.vertices[0:24:3], clip.mesh, 8.0)


def test_the_gallop_moves_the_camel(gallop: MeshClip, data_folder: Folder) -> None:
    folder = data_folder("horse-camel-poses")
    camel = load_mesh(folder / "camel_ref.obj")
    pairs = load_pairs(folder / "horse_camel.cons")
    horse = load_mesh(folder / "horse_ref.obj")
    report = transfer_motion(gallop, camel, pairs, source_rest=horse).report
    assert report["flipped_percent"] == 0
    assert report["edge_ratio"][0] > 0.8 and report["edge_ratio"][1] < 1.2
    assert report["volume_worst"] > -4
    assert report["quaternion_norm_min"] > 0.7


def test_the_gallop_onto_the_horse_itself_with_every_face_marked(gallop: MeshClip, record_property) -> None:
    faces = np.arange(len(gallop.faces))
    result = transfer_motion(gallop, gallop.mesh, Pairs("faces", faces, faces), measure=False)
    error = compare(
        centred(np.asarray(gallop.vertices, float)), centred(doubles(result)), gallop.mesh.diagonal
    )
    record_property("kg", error.kg)
    # rotations alone cannot follow a gallop that stretches: 1.5 % of the diagonal is their floor
    assert error.kg < 10
    assert error.rms_percent < 2.5
    few = np.asarray(load_pairs_of(gallop))
    coarse = transfer_motion(gallop, gallop.mesh, Pairs("vertices", few, few), measure=False)
    worse = compare(
        centred(np.asarray(gallop.vertices, float)), centred(doubles(coarse)), gallop.mesh.diagonal
    )
    assert error.kg < worse.kg < 25


def load_pairs_of(clip: MeshClip) -> np.ndarray:
    """About a hundred vertices, spread evenly."""
    V = np.asarray(clip.rest)
    chosen, gap = [0], np.linalg.norm(V - V[0], axis=1)
    while len(chosen) < 107:
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(V - V[chosen[-1]], axis=1))
    return np.array(chosen)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["02_03.amc", "02_04.amc"])
def test_run_and_jump(name: str, data_folder: Folder, makehuman: SkinnedMesh) -> None:
    clip = every(load_skeleton_clip(data_folder("mocap-cmu") / name), 8)
    for volume, worst in ((0.0, -17), (1.0, -5)):
        result = transfer_motion(clip, makehuman, volume=volume)
        fine(result, direction=5, volume=worst, quaternion=0.85, edges=1.35)
