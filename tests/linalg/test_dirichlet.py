"""Harmonic functions: exact where prescribed, between the extremes elsewhere, linear where they should be."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.geometry import boundary_edges, cotangent_laplacian, edge_laplacian
from tempose.linalg import SparseCholesky, harmonic_extension


def path(n: int) -> sp.csr_array:
    return edge_laplacian(np.column_stack([np.arange(n - 1), np.arange(1, n)]), np.ones(n - 1), n)


@pytest.fixture(scope="module")
def sphere() -> tuple[np.ndarray, np.ndarray, sp.csr_array]:
    mesh = trimesh.creation.icosphere(subdivisions=2)
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)
    return V, F, cotangent_laplacian(V, F, clamp=True)


def test_on_a_path_values_lie_on_the_line_between_the_ends() -> None:
    x = harmonic_extension(path(11), np.array([0, 10]), np.array([[2.0, 0], [7, -1]]))
    assert_allclose(x, np.column_stack([np.linspace(2, 7, 11), np.linspace(0, -1, 11)]), rtol=0, atol=1e-13)


def test_linear_functions_extend_from_the_rim_of_a_flat_patch(rng) -> None:
    x, y = np.meshgrid(np.arange(8.0), np.arange(6.0))
    V = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    V[:, :2] += 0.2 * rng.random((48, 2))
    i = (np.arange(5)[:, None] * 8 + np.arange(7)).ravel()
    F = np.concatenate([np.c_[i, i + 1, i + 9], np.c_[i, i + 9, i + 8]])
    rim = np.unique(boundary_edges(F))
    f = V @ rng.normal(size=(3, 2)) + 1
    assert len(rim) == 24
    assert_allclose(harmonic_extension(cotangent_laplacian(V, F), rim, f[rim]), f, rtol=0, atol=1e-12)


@pytest.mark.parametrize("backend", ["numba", "splu"])
def test_prescribed_values_are_kept_to_the_bit_and_the_rest_is_harmonic(sphere, rng, backend) -> None:
    _, _, L = sphere
    known, values = rng.choice(162, 20, replace=False), rng.normal(size=(20, 3))
    x = harmonic_extension(L, known, values, backend)
    assert_array_equal(x[known], values)
    free = np.setdiff1d(np.arange(162), known)
    assert_allclose((L @ x)[free], 0, rtol=0, atol=1e-12)


def test_the_maximum_principle_holds_for_clamped_weights(sphere, rng) -> None:
    _, _, L = sphere
    known, values = rng.choice(162, 9, replace=False), rng.normal(size=(9, 5))
    x = harmonic_extension(L, known, values)
    assert (x <= values.max(axis=0) + 1e-12).all() and (x >= values.min(axis=0) - 1e-12).all()


def test_partition_of_unity_extends_to_a_partition_of_unity(sphere, rng) -> None:
    _, _, L = sphere
    known = rng.choice(162, 12, replace=False)
    x = harmonic_extension(L, known, sp.eye_array(12, format="csr"))
    assert_allclose(x.sum(axis=1), 1, rtol=0, atol=1e-12)
    assert_allclose(harmonic_extension(L, known, np.full((12, 1), 3.5)), 3.5, rtol=0, atol=1e-12)


def test_it_minimises_the_energy(sphere, rng) -> None:
    _, _, L = sphere
    known, values = rng.choice(162, 9, replace=False), rng.normal(size=(9, 1))
    x = harmonic_extension(L, known, values)
    for _ in range(20):
        change = rng.normal(size=(162, 1))
        change[known] = 0
        assert float(((x + change).T @ L @ (x + change)).item()) > float((x.T @ L @ x).item())


def test_it_is_linear_and_scale_of_weights_does_not_matter(sphere, rng) -> None:
    _, _, L = sphere
    known, a, b = np.arange(0, 162, 11), rng.normal(size=(15, 2)), rng.normal(size=(15, 2))
    summed = harmonic_extension(L, known, 2 * a - b)
    parts = 2 * harmonic_extension(L, known, a) - harmonic_extension(L, known, b)
    assert_allclose(summed, parts, rtol=0, atol=1e-12)
    assert_allclose(
        harmonic_extension(1e6 * L, known, a), harmonic_extension(L, known, a), rtol=0, atol=1e-12
    )


def test_agrees_with_a_dense_solve_and_with_soft_constraints_in_the_limit(sphere, rng) -> None:
    _, _, L = sphere
    known, values = np.arange(0, 162, 9), rng.normal(size=(18, 1))
    x = harmonic_extension(L, known, values)
    free, dense = np.setdiff1d(np.arange(162), known), L.toarray()
    slow = np.linalg.solve(dense[np.ix_(free, free)], -dense[np.ix_(free, known)] @ values)
    assert_allclose(x[free], slow, rtol=0, atol=1e-12)
    pull, target = np.zeros(162), np.zeros((162, 1))
    pull[known], target[known] = 1e9, 1e9 * values
    soft = SparseCholesky(L + sp.diags_array(pull)).solve(target)
    assert_allclose(soft, x, rtol=0, atol=1e-7)


def test_everything_known_and_nothing_known() -> None:
    values = np.arange(10.0).reshape(5, 2)
    assert_array_equal(harmonic_extension(path(5), np.arange(5), values), values)
    with pytest.raises(ValueError, match="hold at least one vertex of every connected component"):
        harmonic_extension(path(5), np.zeros(0, dtype=int), np.zeros((0, 1)))


def test_a_component_without_a_known_value_is_refused() -> None:
    two = sp.block_diag([path(5), path(5)], format="csr")
    with pytest.raises(ValueError, match="hold at least one vertex of every connected component"):
        harmonic_extension(two, np.array([0, 4]), np.zeros((2, 1)))
    assert harmonic_extension(two, np.array([0, 7]), np.ones((2, 1))).min() == pytest.approx(1)


@pytest.mark.parametrize(
    ("known", "values", "message"),
    [
        (np.array([0, 5]), np.zeros((2, 1)), "known must hold indices from 0 and below 5, got 5"),
        (np.array([0, -1]), np.zeros((2, 1)), "known must hold indices from 0"),
        (np.array([0, 3, 3]), np.zeros((3, 1)), "known must hold distinct indices, got 3 more than once"),
        (np.array([0, 3]), np.zeros((3, 1)), r"values must have shape \(2, k\), got \(3, 1\)"),
        (np.array([0, 3]), np.zeros(2), r"values must have shape \(2, k\), got \(2,\)"),
        (np.array([0, 3]), np.full((2, 1), np.nan), "values must be finite"),
    ],
)
def test_bad_values_are_refused(known, values, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        harmonic_extension(path(5), known, values)
