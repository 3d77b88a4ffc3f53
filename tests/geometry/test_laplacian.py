"""The Laplacian is G^T A G, the mass matrix the area, and cotangents obey Gauss and Bonnet."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse as sp
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation

from tempose.geometry import (
    boundary_edges,
    cotangent_laplacian,
    cotangents,
    edge_laplacian,
    face_areas,
    mass_matrix,
)

Surface = tuple[np.ndarray, np.ndarray]


def sphere() -> Surface:
    mesh = trimesh.creation.icosphere(subdivisions=2)
    return np.array(mesh.vertices) * [1, 2, 0.7], np.array(mesh.faces, dtype=np.int32)


def torus() -> Surface:
    mesh = trimesh.creation.torus(2.0, 0.7, major_sections=12, minor_sections=9)
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


def disc() -> Surface:
    """A flat irregular patch in a tilted plane."""
    flat = np.random.default_rng(1).random((60, 2))
    F = Delaunay(flat).simplices.astype(np.int32)
    a, b, c = (flat[F[:, k]] for k in range(3))
    clockwise = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    F[clockwise] = F[clockwise][:, ::-1]
    tilt = Rotation.from_rotvec([0.3, -0.4, 1.0]).as_matrix()
    return np.column_stack([flat, np.zeros(60)]) @ tilt.T + 0.5, F


def nonmanifold() -> Surface:
    """Three fins on one edge, a duplicated face and one that is turned over."""
    rng = np.random.default_rng(2)
    F = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 2], [3, 2, 1]], dtype=np.int32)
    return rng.normal(size=(5, 3)), F


ZOO = {"sphere": sphere, "torus": torus, "disc": disc, "nonmanifold": nonmanifold}
zoo = pytest.mark.parametrize("make", ZOO.values(), ids=ZOO.keys())


def gradient(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Dense (3 m, n) gradient of piecewise linear functions, from the definition."""
    G = np.zeros((len(F), 3, len(V)))
    for f, face in enumerate(F):
        N = np.cross(V[face[1]] - V[face[0]], V[face[2]] - V[face[0]])
        for k in range(3):
            opposite = V[face[(k + 2) % 3]] - V[face[(k + 1) % 3]]
            G[f, :, face[k]] += np.cross(N, opposite) / (N @ N)
    return G.reshape(3 * len(F), len(V))


@zoo
def test_the_laplacian_is_gradient_transpose_area_gradient(make: Callable[[], Surface]) -> None:
    V, F = make()
    G, areas = gradient(V, F), np.repeat(face_areas(V, F), 3)
    assert_allclose(cotangent_laplacian(V, F).toarray(), G.T @ (areas[:, None] * G), rtol=0, atol=1e-11)


@zoo
@pytest.mark.parametrize("clamp", [False, True])
def test_the_laplacian_is_symmetric_semidefinite_and_blind_to_constants(make, clamp: bool) -> None:
    V, F = make()
    L = cotangent_laplacian(V, F, clamp=clamp)
    assert sp.issparse(L) and L.format == "csr" and L.shape == (len(V), len(V))
    dense = L.toarray()
    assert_array_equal(dense, dense.T)
    assert_allclose(dense.sum(axis=1), 0, rtol=0, atol=1e-12)
    eigenvalues = np.linalg.eigvalsh(dense)
    assert eigenvalues[0] > -1e-11
    assert eigenvalues[1] > 1e-6  # connected: constants only


@zoo
def test_clamping_only_cuts_negative_edge_weights(make) -> None:
    V, F = make()
    plain, clamped = (cotangent_laplacian(V, F, clamp=c).toarray() for c in (False, True))
    off = ~np.eye(len(V), dtype=bool)
    assert_allclose(clamped[off], np.minimum(plain, 0)[off], rtol=0, atol=1e-14)
    assert make is torus or (plain[off] > 0).any()


def test_linear_functions_are_harmonic_inside_a_flat_patch(rng) -> None:
    V, F = disc()
    inside = np.setdiff1d(np.arange(len(V)), boundary_edges(F))
    f = V @ rng.normal(size=3) + 4
    assert len(inside) > 20
    assert_allclose((cotangent_laplacian(V, F) @ f)[inside], 0, rtol=0, atol=1e-12)


def test_energy_of_a_linear_function_is_slope_squared_times_area(rng) -> None:
    V, F = disc()
    slope = rng.normal(size=3)
    normal = np.cross(V[F[0, 1]] - V[F[0, 0]], V[F[0, 2]] - V[F[0, 0]])
    normal /= np.linalg.norm(normal)
    within = slope - (slope @ normal) * normal
    energy = (V @ slope) @ cotangent_laplacian(V, F) @ (V @ slope)
    assert energy == pytest.approx((within @ within) * face_areas(V, F).sum(), rel=1e-10)


@pytest.mark.parametrize("degree", [1, 2])
def test_spherical_harmonics_are_eigenfunctions_in_the_limit(degree: int) -> None:
    errors = []
    for level in (2, 3, 4):
        mesh = trimesh.creation.icosphere(subdivisions=level)
        V, F = np.array(mesh.vertices), np.array(mesh.faces)
        f = V[:, 2] if degree == 1 else V[:, 0] * V[:, 1]
        quotient = (f @ cotangent_laplacian(V, F) @ f) / (f @ mass_matrix(V, F, "full") @ f)
        errors.append(abs(quotient - degree * (degree + 1)))
    assert errors[2] < errors[1] / 3 < errors[0] / 9


@zoo
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_weights_do_not_know_unit_nor_place_and_mass_has_units_of_area(make, rng, unit: float) -> None:
    V, F = make()
    moved = unit * (V @ Rotation.random(rng=rng).as_matrix().T + 3.0)
    L = cotangent_laplacian(V, F).toarray()
    assert_allclose(cotangent_laplacian(moved, F).toarray(), L, rtol=0, atol=1e-9)
    for kind in ("lumped", "full"):
        M = mass_matrix(V, F, kind).toarray()
        assert_allclose(mass_matrix(moved, F, kind).toarray(), unit**2 * M, rtol=1e-9)


@zoo
def test_renumbering_permutes_the_matrices(make, rng) -> None:
    V, F = make()
    order = rng.permutation(len(V))
    place = np.argsort(order)
    F2 = place[F][rng.permutation(len(F))][:, [2, 0, 1]]
    for build in (cotangent_laplacian, mass_matrix, lambda V, F: mass_matrix(V, F, "full")):
        expected = build(V, F).toarray()[np.ix_(order, order)]
        assert_allclose(build(V[order], F2).toarray(), expected, rtol=0, atol=1e-12)


@zoo
def test_mass_sums_to_the_area_and_both_kinds_lump_alike(make) -> None:
    V, F = make()
    lumped, full = mass_matrix(V, F).toarray(), mass_matrix(V, F, "full").toarray()
    area = face_areas(V, F).sum()
    assert lumped.sum() == pytest.approx(area, rel=1e-12)
    assert_allclose(full.sum(axis=1), np.diag(lumped), rtol=1e-12)
    assert_array_equal(full, full.T)
    assert np.linalg.eigvalsh(full)[0] > 0
    assert_array_equal(lumped, np.diag(np.diag(lumped)))


def test_full_mass_integrates_products_of_linear_functions_exactly(rng) -> None:
    V, F = disc()
    f, g = V @ rng.normal(size=3), V @ rng.normal(size=3) + 1
    # edge midpoints integrate quadratics exactly
    exact = sum(
        face_areas(V, F) / 3 * (f[F[:, k]] + f[F[:, k - 1]]) / 2 * (g[F[:, k]] + g[F[:, k - 1]]) / 2
        for k in range(3)
    ).sum()
    assert f @ mass_matrix(V, F, "full") @ g == pytest.approx(exact, rel=1e-12)


@zoo
def test_cotangents_are_those_of_the_corner_angles(make) -> None:
    V, F = make()
    half = cotangents(V, F)
    angles = np.arctan2(1, 2 * half)
    assert_allclose(angles.sum(axis=1), np.pi, rtol=1e-12)
    for f, face in enumerate(F):
        for k in range(3):
            a, b = V[face[(k + 1) % 3]] - V[face[k]], V[face[(k + 2) % 3]] - V[face[k]]
            cosine = a @ b / np.linalg.norm(a) / np.linalg.norm(b)
            assert angles[f, k] == pytest.approx(np.arccos(cosine), abs=1e-9)


@pytest.mark.parametrize(("make", "euler"), [(sphere, 2), (torus, 0)])
def test_angle_defects_sum_to_two_pi_times_the_euler_number(make, euler: int) -> None:
    V, F = make()
    angles = np.arctan2(1, 2 * cotangents(V, F))
    defects = 2 * np.pi - np.bincount(F.ravel(), angles.ravel())
    assert defects.sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)
    assert len(V) - len(F) / 2 == euler


def test_equilateral_triangle_and_right_triangle() -> None:
    equilateral = np.array([[0, 0, 0], [1, 0, 0], [0.5, np.sqrt(0.75), 0]])
    F = np.array([[0, 1, 2]])
    assert_allclose(cotangents(equilateral, F), 1 / np.sqrt(12), rtol=1e-12)
    right = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0]])
    assert_allclose(cotangents(right, F), [[0, 0.5, 0.5]], rtol=0, atol=1e-15)
    assert_allclose(
        cotangent_laplacian(right, F).toarray(), [[1, -0.5, -0.5], [-0.5, 0.5, 0], [-0.5, 0, 0.5]]
    )


def test_degenerate_faces_weigh_nothing_and_slivers_little_enough() -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 0], [0.5, 1e-9, 0], [0, 1, 0]])
    line, point, twice = [0, 1, 2], [0, 3, 0], [0, 0, 1]
    assert_array_equal(cotangents(V, np.array([line, point, twice])), np.zeros((3, 3)))
    assert np.abs(cotangents(V, np.array([[0, 1, 4]]))).max() == 1e4
    good = np.array([[0, 1, 5]])
    with_bad = np.array([[0, 1, 5], line, point, twice])
    assert_array_equal(cotangent_laplacian(V, with_bad).toarray(), cotangent_laplacian(V, good).toarray())


def test_edge_laplacian_is_the_sum_of_its_springs(rng) -> None:
    edges, weights = rng.integers(0, 7, size=(20, 2)), rng.random(20)
    dense = np.zeros((7, 7))
    for (i, j), w in zip(edges, weights):
        e = np.zeros(7)
        e[i] += 1
        e[j] -= 1
        dense += w * np.outer(e, e)
    assert_allclose(edge_laplacian(edges, weights, 7).toarray(), dense, rtol=0, atol=1e-13)
    nothing = edge_laplacian(np.zeros((0, 2), dtype=int), np.zeros(0), 3)
    assert_array_equal(nothing.toarray(), np.zeros((3, 3)))


def test_no_face_gives_zero_matrices() -> None:
    V, F = np.ones((3, 3)), np.zeros((0, 3), dtype=np.int32)
    for matrix in (cotangent_laplacian(V, F), cotangent_laplacian(V, F, clamp=True), mass_matrix(V, F)):
        assert_array_equal(matrix.toarray(), np.zeros((3, 3)))
    assert_array_equal(mass_matrix(V, F, "full").toarray(), np.zeros((3, 3)))
