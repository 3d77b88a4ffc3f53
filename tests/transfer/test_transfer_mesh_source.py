"""Rotations read off a deforming surface."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_zoo import ZOO, sphere, tube, wxyz

from tempose.geometry import vertex_adjacency
from tempose.rotations import angle_between
from tempose.transfer.turns.mesh_source import face_patches, patch_rotations, vertex_patches


def rings_of(F: np.ndarray, n: int, seeds: set[int], k: int) -> set[int]:
    A = vertex_adjacency(F, n)
    for _ in range(k):
        seeds = seeds | {int(j) for i in seeds for j in A.indices[A.indptr[i] : A.indptr[i + 1]]}
    return seeds


@pytest.mark.parametrize("rings", [0, 1, 2])
@pytest.mark.parametrize("name", ["sphere", "sheet", "tube", "dirty"])
def test_a_rigidly_moved_source_gives_its_rotation(name: str, rings: int, rng) -> None:
    mesh = ZOO[name]()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    corners = V[F]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    faces = np.flatnonzero(area > 1e-6)[::7]
    R = Rotation.random(4, rng=rng)
    frames = np.stack([r.apply(V) + rng.normal(size=3) for r in R])
    Q = patch_rotations(frames, V, F, face_patches(F, len(V), faces, rings))
    assert_allclose(angle_between(Q, wxyz(R)[:, None]), 0, rtol=0, atol=1e-6)
    assert_allclose(np.linalg.norm(Q, axis=-1), 1, rtol=0, atol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_size_means_nothing(unit: float, rng) -> None:
    mesh = sphere()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    frames = V + 0.1 * rng.normal(size=(2, *V.shape))
    patches = vertex_patches(F, len(V), np.arange(0, 100, 9))
    expected = patch_rotations(frames, V, F, patches)
    assert_allclose(angle_between(patch_rotations(unit * frames, V, F, patches), expected), 0, atol=1e-7)
    assert_allclose(angle_between(patch_rotations(frames, unit * V, F, patches), expected), 0, atol=1e-7)


def test_it_is_the_polar_factor_of_the_best_linear_map(rng) -> None:
    mesh = sphere()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    frame = V @ Rotation.random(rng=rng).as_matrix().T + 0.2 * rng.normal(size=V.shape)
    patches = vertex_patches(F, len(V), np.array([3, 77]))
    Q = patch_rotations(frame[None], V, F, patches)[0]
    for patch, q in zip(patches, Q):
        p, now = V[patch] - V[patch].mean(axis=0), frame[patch] - frame[patch].mean(axis=0)
        best, _ = Rotation.align_vectors(now, p)
        assert angle_between(wxyz(best), q) < 1e-6


def test_a_single_face_turns_by_its_edges_and_its_normal(rng) -> None:
    """Even where it is stretched, a triangle's normal goes to its normal, exactly."""
    V, F = rng.normal(size=(3, 3)), np.array([[0, 1, 2]])
    frames = rng.normal(size=(5, 3, 3))
    Q = patch_rotations(frames, V, F, face_patches(F, 3, np.array([0]), 0))[:, 0]
    for frame, q in zip(frames, Q):
        n0, n1 = (np.cross(X[1] - X[0], X[2] - X[0]) for X in (V, frame))
        turned = Rotation.from_quat(q[[1, 2, 3, 0]]).apply(n0 / np.linalg.norm(n0))
        assert_allclose(turned, n1 / np.linalg.norm(n1), rtol=0, atol=1e-6)


def test_turned_round_patches_never_become_mirrors() -> None:
    """A flat patch has a mirror image that fits as well: the rotation must be one."""
    grid = ZOO["sheet"]()
    V = np.array(grid.vertices) * [1, 0, 1]
    F = np.array(grid.faces)
    R = Rotation.from_rotvec(np.radians([0, 90, 179, 181, 270])[:, None] * [1.0, 0, 0])
    frames = np.stack([r.apply(V) for r in R])
    patches = vertex_patches(F, len(V), np.array([40]))
    assert_allclose(angle_between(patch_rotations(frames, V, F, patches)[:, 0], wxyz(R)), 0, atol=1e-6)


@pytest.mark.parametrize("rings", [1, 2, 3])
def test_patches_reach_as_many_edges_as_they_say(rings: int) -> None:
    mesh = tube(9, 10)
    F, n = np.array(mesh.faces), len(mesh.vertices)
    seeds = np.array([4, 33, n - 1])
    for seed, patch in zip(seeds, vertex_patches(F, n, seeds, rings)):
        assert set(patch) == rings_of(F, n, {int(seed)}, rings)
    for face, patch in zip([2, 50], face_patches(F, n, np.array([2, 50]), rings)):
        assert set(patch) == rings_of(F, n, {int(v) for v in F[face]}, rings)
    alone = face_patches(F, n, np.array([2, 50]), 0)
    assert_array_equal(alone, F[[2, 50]])


def test_single_precision_frames_lose_no_more_than_their_own_digits(rng) -> None:
    mesh = sphere()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    R = Rotation.random(rng=rng)
    frames = R.apply(V)[None].astype(np.float32)
    Q = patch_rotations(frames, V, F, vertex_patches(F, len(V), np.arange(20)))
    assert angle_between(Q, wxyz(R)).max() < 3e-6
