"""Skin pushed out: the volume comes back, nothing else moves, and the rest stays the rest."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, human_body, t_body, t_pose
from transfer_zoo import sphere, tube

from tempose.clips import Mesh
from tempose.geometry import weld
from tempose.metrics import Enclosed, volume_change, volumes
from tempose.transfer import pairs_from_skin, transfer_motion
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.joint_patches import inner_strengths, joint_patches
from tempose.transfer.quality.volume_report import joint_volumes
from tempose.transfer.solver._fill_kernel import fill_patch
from tempose.transfer.solver.fill import CAP, VolumeFill, make_patch
from tempose.transfer.solver.links import inner_edges
from tempose.transfer.solver.welded import Welded


def welded(mesh: Mesh) -> Welded:
    first, inverse = weld(mesh.vertices)
    return Welded(mesh.vertices[first], inverse[mesh.faces], first, inverse)


def waist(mesh: Mesh, unit: float = 1.0):
    """The patch round the middle of a tube."""
    return make_patch(welded(mesh), np.arange(len(mesh.faces)), unit * np.array([0, 1.0, 0]), 0.6 * unit)


def pinched(mesh: Mesh, by: float) -> np.ndarray:
    """Frames of a tube that is thinner at its middle, less and more."""
    y = mesh.vertices[:, 1] / mesh.vertices[:, 1].max()
    thin = 1 - by * np.array([0.25, 0.5, 1.0])[:, None] * np.exp(-(((y - 0.5) / 0.1) ** 2))
    return mesh.vertices * np.stack([thin, np.ones_like(thin), thin], axis=-1)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_a_pinched_tube_gets_its_volume_back(unit: float) -> None:
    mesh = tube(41, 24)
    mesh = mesh.with_vertices(unit * mesh.vertices)
    patch = waist(mesh, unit)
    V = pinched(mesh, 0.2)
    faces = patch.vertices[patch.faces]
    lost = volume_change(V, faces, mesh.vertices)
    VolumeFill(mesh.vertices, [patch]).apply(V)
    left = volume_change(V, faces, mesh.vertices)
    assert (lost < [-0.5, -1, -2]).all()
    assert (np.abs(left) < 0.1 * np.abs(lost)).all()


def test_half_the_strength_gives_half_back() -> None:
    mesh = tube(41, 24)
    patch, plain = waist(mesh), pinched(mesh, 0.05)
    changes = []
    for strength in (0.0, 0.5, 1.0):
        V = plain.copy()
        VolumeFill(mesh.vertices, [patch], strength).apply(V)
        changes.append(volume_change(V, patch.vertices[patch.faces], mesh.vertices))
    assert_allclose(changes[1], 0.5 * (changes[0] + changes[2]), atol=0.05)


def test_rest_and_rigid_motion_stay_and_turning_turns(rng) -> None:
    mesh = sphere(3)
    patch = make_patch(welded(mesh), np.arange(len(mesh.faces)), mesh.vertices[0], 0.7)
    R = Rotation.random(rng=rng).as_matrix()
    V = np.stack([mesh.vertices, mesh.vertices @ R.T + [3.0, -1, 2]])
    before = V.copy()
    fill = VolumeFill(mesh.vertices, [patch])
    fill.apply(V)
    assert_allclose(V, before, rtol=0, atol=1e-12)
    dented = (mesh.vertices * [0.9, 1.0, 0.95])[None]
    turned = dented @ R.T
    fill.apply(dented)
    fill.apply(turned)
    assert_allclose(turned, dented @ R.T, rtol=0, atol=1e-12)


def test_only_the_patch_moves_and_least_at_its_rim() -> None:
    mesh = tube(41, 24)
    patch = waist(mesh)
    V = pinched(mesh, 0.2)
    before = V.copy()
    VolumeFill(mesh.vertices, [patch]).apply(V)
    moved = np.linalg.norm(V - before, axis=2)[-1]
    assert (moved[np.setdiff1d(np.arange(len(moved)), patch.vertices)] == 0).all()
    rim = np.linalg.norm(mesh.vertices[patch.vertices] - [0, 1.0, 0], axis=1) > 0.55
    assert moved[patch.vertices][rim].max() < 0.1 * moved.max()


def test_a_push_is_bounded_and_smooth() -> None:
    """Whatever is missing, no vertex goes further than the cap; a little more missing, a little further."""
    mesh = tube(41, 24)
    patch = waist(mesh)
    missing = np.linspace(0, 10 * volumes(mesh.vertices[None], mesh.faces)[0], 200)
    X = np.repeat(mesh.vertices[patch.vertices][None], 200, axis=0)
    fill_patch(X, patch.faces, patch.bump, missing, CAP * patch.radius, 2)
    moved = np.linalg.norm(X - X[0], axis=2).max(axis=1)
    assert moved.max() <= CAP * patch.radius + 1e-12
    assert (np.diff(moved) >= -1e-12).all()


@pytest.mark.parametrize("smooth", [0, 3])
def test_the_kernel_against_plain_arrays(rng, smooth: int) -> None:
    mesh = sphere(2)
    patch = make_patch(welded(mesh), np.arange(len(mesh.faces)), mesh.vertices[5], 0.8)
    X = mesh.vertices[patch.vertices] + 0.02 * rng.normal(size=(3, len(patch.vertices), 3))
    missing, cap = np.array([0.01, -0.02, 0.5]), 0.1
    expected = X.copy()
    for t in range(3):
        g = np.zeros_like(X[t])
        for i, j, k in patch.faces:
            area = np.cross(X[t, j] - X[t, i], X[t, k] - X[t, i]) / 6
            g[[i, j, k]] += area
        d = g
        for _ in range(smooth):
            d, before = np.zeros_like(g), d
            for corners in patch.faces:
                d[corners] += before[corners].sum(axis=0)
        d = (patch.bump / np.linalg.norm(d, axis=1))[:, None] * d
        expected[t] += cap * np.tanh(missing[t] / (d * g).sum() / cap) * d
    fill_patch(X, patch.faces, patch.bump, missing, cap, smooth)
    assert_allclose(X, expected, rtol=0, atol=1e-12)


def test_a_texture_seam_does_not_open() -> None:
    mesh = tube(41, 24)
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    split = np.unique(F[::2])
    copy = np.full(len(V), -1)
    copy[split] = len(V) + np.arange(len(split))
    F[::2] = copy[F[::2]]
    seamed = Mesh(np.concatenate([V, V[split]]), F)
    frames = pinched(mesh, 0.2)
    both = np.concatenate([frames, frames[:, split]], axis=1)
    for body, X in ((mesh, frames), (seamed, both)):
        VolumeFill(body.vertices, [waist(body)]).apply(X)
    assert_allclose(both[:, : len(V)], frames, rtol=0, atol=1e-12)
    assert_allclose(both[:, len(V) :], frames[:, split], rtol=0, atol=1e-12)


def test_a_hand_beside_the_hip_is_no_part_of_it() -> None:
    """Patches hold only faces of bones at most two steps from the joint."""
    body = human_body()
    clip = clip_of(body.skeleton, {}, 1)
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body))
    patches = joint_patches(job.solver, job.bones, job.target, job.owner)
    for side in ("left_", "right_"):
        assert {side + p for p in ("upper_arm", "forearm", "forearm_middle", "thigh", "shin")} <= set(patches)
        mine = {job.bones.roles[b] for b in np.unique(job.owner[patches[side + "thigh"].vertices])}
        assert not mine & {side + "hand", side + "forearm"}


def raised(**options: object) -> dict[str, object]:
    turns = {
        "left_forearm": about("y", -100),
        "right_shin": about("x", 100),
        "right_thigh": about("x", -60),
    }
    return transfer_motion(clip_of(t_pose(), turns, 2), t_body(), contacts=False, **options).report


def test_bent_joints_keep_their_volume_when_asked_to() -> None:
    without, with_ = raised()["joint_volume"], raised(volume=1.0)["joint_volume"]
    for joint in ("left_forearm", "right_shin", "right_thigh"):
        assert without[joint]["worst"] < -3
        assert abs(with_[joint]["worst"]) < 0.4 * abs(without[joint]["worst"])
    assert len(without["left_shin"]["frames"]) == 2


def test_the_report_agrees_with_measuring_each_frame_alone() -> None:
    mesh = tube(41, 24)
    patch, V = waist(mesh), pinched(mesh, 0.2)
    found = joint_volumes(V, mesh.vertices, {"waist": patch})["joint_volume"]["waist"]
    change = volume_change(V, patch.vertices[patch.faces], mesh.vertices)
    assert_allclose(found["frames"], change, atol=0.006)
    assert found["worst"] == pytest.approx(change.min(), abs=0.006)
    assert found["mean"] == pytest.approx(change.mean(), abs=0.006)


def test_enclosed_is_what_volumes_says(rng) -> None:
    mesh = tube(9, 8)
    F = mesh.faces[rng.choice(len(mesh.faces), 60, replace=False)]
    V = mesh.vertices + 0.05 * rng.normal(size=(4, len(mesh.vertices), 3))
    assert_allclose(Enclosed(F, V.shape[1]).volumes(V), volumes(V, F), rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match="F must hold indices"):
        Enclosed(F, 5)


def test_inner_edges_may_differ_from_vertex_to_vertex() -> None:
    mesh = tube(15, 12)
    V, F = mesh.vertices, mesh.faces
    strength = np.where(V[:, 1] < 1, 2.0, 0.0)
    whole, part = inner_edges(V, F, 1.0), inner_edges(V, F, strength)
    kept = strength[whole.pairs[:, 0]] > 0
    assert (part.pairs == whole.pairs[kept]).all()
    assert_allclose(part.weights, 2 * whole.weights[kept])
    assert len(inner_edges(V, F, np.zeros(len(V))).pairs) == 0


def test_inner_edges_are_fainter_round_the_shoulder() -> None:
    strengths = inner_strengths(["left_thigh", "left_upper_arm", "chest", ""], 2.0)
    assert strengths[0] == strengths[3] > 2 * strengths[1] == 2 * strengths[2] > 0
    assert (inner_strengths(["hips"], 0.0) == 0).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"volume": -1.0}, "volume must be 0 or more, got -1"),
        ({"volume": float("nan")}, "volume must be 0 or more, got nan"),
        ({"lead": 1.5}, "lead must be a share from 0 to 1, got 1.5"),
        ({"singular": "both"}, "singular must be one of reference, path, none, got 'both'"),
    ],
)
def test_options_that_make_no_sense_are_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        transfer_motion(clip_of(t_pose(), {}, 1), t_body(), **options)
