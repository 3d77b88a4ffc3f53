"""Areas and normals of figures whose areas and normals are known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.geometry import face_areas, face_normals, vertex_areas, vertex_normals


@pytest.fixture(scope="module")
def box() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.box(extents=(1, 2, 3)).subdivide()
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


def test_a_box_has_the_area_of_its_sides_and_outward_normals(box) -> None:
    V, F = box
    assert face_areas(V, F).sum() == pytest.approx(22, rel=1e-12)
    N, centre = face_normals(V, F), V[F].mean(axis=1)
    assert_allclose(np.abs(N).max(axis=1), 1, rtol=1e-12)
    assert (np.sum(N * centre, axis=1) > 0.4).all()
    assert_allclose(face_normals(V, F[:, ::-1]), -N, rtol=0, atol=1e-15)


def test_area_vectors_of_a_closed_surface_cancel(rng) -> None:
    mesh = trimesh.creation.icosphere(subdivisions=2)
    V, F = np.array(mesh.vertices) + 0.1 * rng.normal(size=mesh.vertices.shape), np.array(mesh.faces)
    assert_allclose(face_areas(V, F) @ face_normals(V, F), 0, rtol=0, atol=1e-13)


def test_vertex_normals_of_a_sphere_point_outwards() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=3)
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    N = vertex_normals(V, F)
    assert_allclose(np.linalg.norm(N, axis=1), 1, rtol=1e-12)
    assert np.sum(N * V, axis=1).min() > 0.999


def test_vertex_normals_agree_with_a_loop(box, rng) -> None:
    V, F = box
    V = V + 0.1 * rng.normal(size=V.shape)
    summed = np.zeros_like(V)
    for f in F:
        summed[f] += np.cross(V[f[1]] - V[f[0]], V[f[2]] - V[f[0]])
    expected = summed / np.linalg.norm(summed, axis=1, keepdims=True)
    assert_allclose(vertex_normals(V, F), expected, rtol=0, atol=1e-13)


def test_vertex_areas_are_thirds_and_sum_to_the_whole(box) -> None:
    V, F = box
    areas = vertex_areas(V, F)
    assert areas.sum() == pytest.approx(22, rel=1e-12)
    for v in range(len(V)):
        mine = (F == v).any(axis=1)
        assert areas[v] == pytest.approx(face_areas(V, F)[mine].sum() / 3, rel=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_rotation_turns_normals_and_scale_squares_areas(box, rng, unit: float) -> None:
    V, F = box
    R = Rotation.random(rng=rng).as_matrix()
    moved = unit * (V @ R.T + 4)
    assert_allclose(face_areas(moved, F), unit**2 * face_areas(V, F), rtol=1e-9)
    assert_allclose(face_normals(moved, F), face_normals(V, F) @ R.T, rtol=0, atol=1e-11)
    assert_allclose(vertex_normals(moved, F), vertex_normals(V, F) @ R.T, rtol=0, atol=1e-11)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_frames_of_a_batch_equal_single_frames(box, rng, shape: tuple[int, ...]) -> None:
    V, F = box
    batch = V + rng.normal(size=(*shape, 1, 3)) + 0.1 * rng.normal(size=(*shape, *V.shape))
    areas, normals = face_areas(batch, F), face_normals(batch, F)
    assert areas.shape == (*shape, len(F)) and normals.shape == (*shape, len(F), 3)
    for index in np.ndindex(shape):
        assert_array_equal(areas[index], face_areas(batch[index], F))
        assert_array_equal(normals[index], face_normals(batch[index], F))


def test_faces_without_area_and_vertices_without_faces_have_zero_normals() -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    F = np.array([[0, 1, 2], [1, 1, 0]])
    assert_array_equal(face_areas(V, F), [0, 0])
    assert_array_equal(face_normals(V, F), np.zeros((2, 3)))
    assert_array_equal(vertex_normals(V, F), np.zeros((4, 3)))
    assert_array_equal(vertex_areas(V, F), np.zeros(4))
    assert vertex_areas(V, F[:0]).dtype == np.float64
