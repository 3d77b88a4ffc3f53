"""Volumes of bodies whose volume is known, with and without holes."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.metrics import (
    _frames,
    component_volume_change,
    component_volumes,
    patch_round,
    volume_change,
    volumes,
)


@pytest.fixture(scope="module")
def box() -> tuple[np.ndarray, np.ndarray]:
    """A box of 1 x 2 x 3, subdivided."""
    mesh = trimesh.creation.box(extents=(1, 2, 3)).subdivide().subdivide()
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


@pytest.fixture(scope="module")
def tube() -> tuple[np.ndarray, np.ndarray]:
    """An open regular 16-gon prism of radius 1 along Y from -5 to 5, normals outwards."""
    k, rows = 16, 21
    angle = 2 * np.pi * np.arange(k) / k
    ring = np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
    V = (ring + np.linspace(-5, 5, rows)[:, None, None] * [0, 1, 0]).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(k), indexing="ij")
    a, b = (i * k + j).ravel(), (i * k + (j + 1) % k).ravel()
    return V, np.concatenate([np.c_[a, b, b + k], np.c_[a, b + k, a + k]]).astype(np.int32)


TURN = Rotation.from_rotvec([0.3, 0.5, 0.7]).as_matrix()


def prism(length: float) -> float:
    return 16 / 2 * math.sin(2 * np.pi / 16) * length


def test_a_box_has_its_volume_and_minus_it_inside_out(box) -> None:
    V, F = box
    assert volumes(V[None], F)[0] == pytest.approx(6, rel=1e-12)
    assert volumes(V[None], F[:, ::-1])[0] == pytest.approx(-6, rel=1e-12)


def test_an_ellipsoid_converges_at_second_order_in_edge_length() -> None:
    errors = []
    for level in (2, 3, 4):
        mesh = trimesh.creation.icosphere(subdivisions=level)
        errors.append(4 / 3 * np.pi * 6 - volumes((mesh.vertices * [1, 2, 3])[None], np.array(mesh.faces))[0])
    assert_allclose(np.divide(errors[:-1], errors[1:]), 4, rtol=0.03)


def test_an_open_tube_is_closed_by_flat_fans(tube) -> None:
    assert volumes(tube[0][None], tube[1])[0] == pytest.approx(prism(10), rel=1e-12)


@pytest.mark.parametrize("count", [1, 5, 60])
def test_holes_in_flat_sides_do_not_change_the_volume(box, rng, count: int) -> None:
    V, F = box
    normals = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    top = np.flatnonzero(normals[:, 1] > 0.9 * np.linalg.norm(normals, axis=1))
    gone = rng.choice(top, size=min(count, len(top)), replace=False)
    assert volumes(V[None], np.delete(F, gone, axis=0))[0] == pytest.approx(6, rel=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_rigid_motion_keeps_it_and_scale_cubes_it_holes_or_not(box, rng, unit: float) -> None:
    V, F = box
    for faces in (F, F[:-40], F[::3]):
        R = Rotation.random(5, rng=rng).as_matrix()
        clip = unit * (np.einsum("tij,nj->tni", R, V) + 20 * rng.normal(size=(5, 1, 3)))
        expected = unit**3 * volumes(V[None], faces)[0]
        assert_allclose(volumes(clip, faces), expected, rtol=1e-9)


def test_orientation_conflicts_and_third_faces_still_close(box, rng) -> None:
    V, F = box
    broken = np.concatenate([F, F[:3], [[0, 9, 40]]])
    broken[::7] = broken[::7, ::-1]
    shifted = V + np.array([100.0, -50, 30])
    assert volumes(shifted[None], broken)[0] == pytest.approx(volumes(V[None], broken)[0], rel=1e-9)


def test_a_vertex_without_a_face_has_no_say(box) -> None:
    V, F = box
    inside_out = F.copy()
    inside_out[5] = inside_out[5, ::-1]  # its edges now run twice the same way
    for faces in (F[3:], inside_out):
        expected = volumes(V[None], faces)[0]
        for lone in ([[9.0, -70, 30]], [[0.0, 0, 0]] * 500):
            assert volumes(np.concatenate([V, lone])[None], faces)[0] == pytest.approx(expected, rel=1e-12)


def test_renumbering_and_cutting_into_blocks_change_nothing(box, rng, monkeypatch) -> None:
    V, F = box
    clip, open_ = V + 0.1 * rng.normal(size=(6, *V.shape)), F[20:]
    expected = volumes(clip, open_)
    order = rng.permutation(len(V))
    renumbered = np.argsort(order)[open_][rng.permutation(len(open_))]
    monkeypatch.setattr(_frames, "BLOCK_VALUES", 1)
    assert_allclose(volumes(clip[:, order], renumbered), expected, rtol=1e-12)


def test_slow_twin_with_loops_and_fans(box, rng) -> None:
    V, F = box
    corners = np.isin(F, [0, 7])  # the rings of two opposite corners: two simple holes
    v, open_ = V + 0.1 * rng.normal(size=V.shape), F[~corners.any(axis=1)]
    half = {(int(f[k]), int(f[(k + 1) % 3])) for f in open_ for k in range(3)}
    rim = {a: b for a, b in half if (b, a) not in half}
    total = sum(np.linalg.det(v[f]) for f in open_)
    while rim:
        loop = [next(iter(rim))]
        while loop[-1] in rim:
            loop.append(rim.pop(loop[-1]))
        apex = v[loop[:-1]].mean(axis=0)
        total += sum(np.linalg.det([v[b], v[a], apex]) for a, b in pairwise(loop))
    assert volumes(v[None], open_)[0] == pytest.approx(total / 6, rel=1e-9)


def test_change_is_in_percent_of_rest_over_the_frames(box) -> None:
    V, F = box
    clip = np.stack([V, V * [2, 1, 1], 0.5 * V, -V, 0 * V])
    assert_allclose(volume_change(clip, F, V), [0, 100, -87.5, -200, -100], rtol=0, atol=1e-10)
    # an inside-out mesh loses what it loses all the same
    assert_allclose(volume_change(clip, F[:, ::-1], V), [0, 100, -87.5, -200, -100], rtol=0, atol=1e-10)


def two_bodies(box) -> tuple[np.ndarray, np.ndarray]:
    V, F = box
    sheet = np.array([[9.0, 0, 0], [10, 0, 0], [9, 1, 0]])
    return np.concatenate([V, 2 * V + np.array([20.0, 0, 0]), sheet, [[50.0, 50, 50]]]), np.concatenate(
        [F, F + len(V), [[2 * len(V), 2 * len(V) + 1, 2 * len(V) + 2]]]
    )


def test_every_component_has_its_own_volume(box) -> None:
    V, F = two_bodies(box)
    assert_allclose(component_volumes(V[None], F), [[6, 48, 0]], rtol=0, atol=1e-10)
    n = len(box[0])
    posed = V.copy()
    posed[n : 2 * n] *= 0.5
    change = component_volume_change(np.stack([V, posed]), F, V)
    assert_allclose(change[:, :2], [[0, 0], [0, -87.5]], rtol=0, atol=1e-9)
    assert np.isnan(change[:, 2]).all()


def test_components_sum_to_the_whole_with_holes_in_each(box, rng) -> None:
    V, F = two_bodies(box)
    clip = V + 0.1 * rng.normal(size=(3, *V.shape))
    holed = np.delete(F, [0, 1, 50, len(F) // 2 + 7], axis=0)
    assert_allclose(component_volumes(clip, holed).sum(axis=1), volumes(clip, holed), rtol=1e-9)


def test_a_patch_round_a_joint_measures_its_own_piece(tube) -> None:
    V, F = tube
    patch = patch_round(V, F, np.array([0.0, 0, 0]), radius=2.26)
    # rings stand every half metre: those up to 2 m from the middle lie in the ball
    assert np.abs(V[F[patch]][..., 1]).max() == pytest.approx(2)
    assert volumes(V[None], F[patch])[0] == pytest.approx(prism(4), rel=1e-12)
    thin = V * [0.5, 1, 0.5]
    assert_allclose(volume_change(np.stack([V, thin]), F[patch], V), [0, -75], rtol=0, atol=1e-9)
    far = np.where(np.abs(V[:, 1:2]) > 3, V * [3, 1, 3], V)
    assert_allclose(volume_change(far[None], F[patch], V), [0], rtol=0, atol=1e-9)


def test_of_two_pieces_in_the_ball_the_nearer_is_taken(tube) -> None:
    V, F = tube
    both = np.concatenate([V, V + np.array([4.0, 0, 0])])
    F2 = np.concatenate([F, F + len(V)])
    first = patch_round(both, F2, np.array([1.5, 0, 0]), 4.5)
    second = patch_round(both, F2, np.array([2.5, 0, 0]), 4.5)
    assert first.max() < len(F) <= second.min()
    assert_array_equal(first, patch_round(V, F, np.array([1.5, 0, 0]), 4.5))


def test_a_patch_that_reaches_nothing_is_refused(tube) -> None:
    with pytest.raises(
        ValueError, match=r"radius must reach the surface, got 0.5 .* nearest vertex is 1 away"
    ):
        patch_round(*tube, np.zeros(3), 0.5)


@pytest.mark.parametrize(
    "flat", [lambda V: V * [1, 0, 1], lambda V: (V * [1, 0, 1]) @ TURN.T + 0.3, lambda V: 0 * V]
)
def test_a_rest_pose_without_volume_is_refused(box, flat) -> None:
    V, F = box
    with pytest.raises(ValueError, match="V_rest must enclose a volume, got"):
        volume_change(V[None], F, flat(V))
    with pytest.raises(ValueError, match="V_rest must enclose a volume"):
        volume_change(V[None], F[:0], V)


def test_no_face_encloses_nothing() -> None:
    none = np.zeros((0, 3), dtype=int)
    assert_array_equal(volumes(np.ones((2, 3, 3)), none), [0, 0])
    assert component_volumes(np.ones((2, 3, 3)), none).shape == (2, 0)


@pytest.mark.parametrize("measure", [volumes, component_volumes])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda V, F: (V, F), r"V must be numbers of shape \(T, n, 3\)"),
        (lambda V, F: (V[None] * np.inf, F), "V must be finite"),
        (lambda V, F: (V[None], F + len(V)), "F must hold indices"),
        (lambda V, F: (V[None, :0], F), "at least one frame and one vertex"),
    ],
)
def test_bad_input_is_refused(box, measure, change, message: str) -> None:
    V, F = box
    with np.errstate(invalid="ignore"), pytest.raises(ValueError, match=message):
        measure(*change(V, F))
