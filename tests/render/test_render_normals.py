"""Shading normals: exact on known surfaces, sharp where asked."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

from tempose.render.normals import corner_normals


def cube():
    box = trimesh.creation.box()
    return np.asarray(box.vertices), np.asarray(box.faces)


def test_normals_of_a_sphere_are_radial():
    ball = trimesh.creation.icosphere(subdivisions=3)
    N = corner_normals(ball.vertices, ball.faces)
    assert_allclose((N * ball.vertices[ball.faces]).sum(axis=2), 1.0, atol=1e-3)


def test_smooth_normals_of_a_cube_are_its_diagonals_whatever_the_diagonals_of_its_sides():
    V, F = cube()
    assert_allclose(corner_normals(V, F), V[F] / np.linalg.norm(V[F], axis=2, keepdims=True), atol=1e-12)


def test_a_crease_keeps_the_sides_of_a_cube_flat():
    V, F = cube()
    flat = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    assert_allclose(corner_normals(V, F, np.radians(60)), np.repeat(flat[:, None], 3, axis=1), atol=1e-12)


def test_a_crease_wider_than_every_edge_changes_nothing(rng):
    ball = trimesh.creation.icosphere(subdivisions=2)
    V = ball.vertices + 0.05 * rng.normal(size=ball.vertices.shape)
    assert_allclose(corner_normals(V, ball.faces, np.pi), corner_normals(V, ball.faces), atol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("crease", [None, 0.5])
def test_normals_do_not_depend_on_the_unit(unit, crease):
    V, F = cube()
    assert_allclose(corner_normals(unit * V, F, crease), corner_normals(V, F, crease), atol=1e-12)


def test_a_triangle_without_area_has_no_say():
    V, F = cube()
    with_sliver = np.concatenate([F, [[0, 0, 1], [F[0, 0], F[0, 1], F[0, 1]]]])
    N = corner_normals(V, with_sliver)
    assert np.isfinite(N).all()
    assert_allclose(N[: len(F)], corner_normals(V, F), atol=1e-12)
