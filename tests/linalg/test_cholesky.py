"""One interface, three solvers, one answer; what cannot be solved says so."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
import scipy.sparse as sp
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.geometry import cotangent_laplacian, mass_matrix
from tempose.linalg import SparseCholesky

HAS_CHOLESPY = importlib.util.find_spec("cholespy") is not None
BACKENDS = ["numba", "splu"] + ["cholespy"] * HAS_CHOLESPY
backends = pytest.mark.parametrize("backend", BACKENDS)


def screened(level: int = 2) -> sp.csc_array:
    mesh = trimesh.creation.icosphere(subdivisions=level)
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)
    return sp.csc_array(cotangent_laplacian(V, F) + mass_matrix(V, F))


def random_definite(rng: np.random.Generator, n: int) -> sp.csc_array:
    B = sp.random_array((n, n), density=0.1, rng=rng)
    return sp.csc_array(B @ B.T + sp.eye_array(n))


@backends
@pytest.mark.parametrize("k", [0, 1, 3, 95, 96, 97, 200])
def test_residuals_vanish_for_any_number_of_sides(rng, backend: str, k: int) -> None:
    A = screened()
    b = rng.normal(size=(A.shape[0], k))
    x = SparseCholesky(A, backend).solve(b)
    assert x.shape == b.shape
    assert_allclose(A @ x, b, rtol=0, atol=1e-12)


@backends
@pytest.mark.parametrize("n", [1, 2, 7, 60])
def test_agrees_with_a_dense_solve(rng, backend: str, n: int) -> None:
    A, b = random_definite(rng, n), rng.normal(size=(n, 4))
    assert_allclose(SparseCholesky(A, backend).solve(b), np.linalg.solve(A.toarray(), b), rtol=0, atol=1e-11)


@backends
def test_one_side_is_a_vector_and_equals_its_column(rng, backend: str) -> None:
    A = screened()
    solver, b = SparseCholesky(A, backend), rng.normal(size=(A.shape[0], 5))
    together = solver.solve(b)
    for c in range(5):
        alone = solver.solve(b[:, c])
        assert alone.shape == (A.shape[0],)
        assert_allclose(alone, together[:, c], rtol=0, atol=1e-14)


@backends
def test_prefactored_equals_one_off_and_gives_the_same_bits_again(rng, backend: str) -> None:
    A, b = screened(), rng.normal(size=(162, 3))
    solver = SparseCholesky(A, backend)
    solver.solve(rng.normal(size=(162, 7)))
    assert_array_equal(solver.solve(b), SparseCholesky(A, backend).solve(b))


def test_backends_agree_to_rounding(rng) -> None:
    A, b = screened(3), rng.normal(size=(642, 3))
    answers = [SparseCholesky(A, backend).solve(b) for backend in BACKENDS]
    for other in answers[1:]:
        assert_allclose(other, answers[0], rtol=0, atol=1e-11)


@backends
@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_units_of_the_matrix_do_not_matter(rng, backend: str, scale: float) -> None:
    A, b = screened(), rng.normal(size=162)
    expected = SparseCholesky(A, backend).solve(b)
    assert_allclose(scale * SparseCholesky(scale * A, backend).solve(b), expected, rtol=1e-9)


@backends
def test_the_right_hand_side_is_left_alone_in_any_layout(rng, backend: str) -> None:
    A, b = screened(), rng.normal(size=(162, 6))
    solver, before = SparseCholesky(A, backend), b.copy()
    expected = solver.solve(b)
    for same in (np.asfortranarray(b), b.astype(np.float64)[::-1][::-1], np.repeat(b, 2, axis=1)[:, ::2]):
        assert_array_equal(solver.solve(same), expected)
    assert_array_equal(b, before)


@backends
@pytest.mark.parametrize("format_", ["csr", "csc", "coo"])
def test_any_sparse_format_will_do(rng, backend: str, format_: str) -> None:
    A, b = screened(), rng.normal(size=162)
    assert_allclose(A @ SparseCholesky(A.asformat(format_), backend).solve(b), b, rtol=0, atol=1e-12)


@backends
@pytest.mark.parametrize("level", [1, 2, 3])
@pytest.mark.parametrize("copies", [1, 2])
def test_a_laplacian_with_a_free_component_is_refused_with_advice(
    backend: str, level: int, copies: int
) -> None:
    mesh = trimesh.creation.icosphere(subdivisions=level)
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)
    L = sp.block_diag([cotangent_laplacian(V, F)] * copies, format="lil")
    L[0, 0] += copies - 1  # of two components only the first is held
    with pytest.raises(
        ValueError, match=r"not positive definite .* hold at least one vertex of every connected"
    ):
        SparseCholesky(sp.csc_array(L), backend)


@backends
@pytest.mark.parametrize(
    "A", [[[1.0, 2], [2, 1]], [[-1.0, 0], [0, 1]], [[0.0, 0], [0, 1]], [[1.0, 1], [1, 1]]]
)
def test_indefinite_and_singular_matrices_are_refused(backend: str, A) -> None:
    with pytest.raises(ValueError, match="A is not positive definite"):
        SparseCholesky(sp.csc_array(np.array(A)), backend)


@backends
def test_a_badly_scaled_but_definite_matrix_is_accepted(backend: str) -> None:
    d = np.array([1e-8, 1.0, 1e8])
    x = SparseCholesky(sp.csc_array(np.diag(d)), backend).solve(d)
    assert_allclose(x, 1, rtol=1e-12)


@backends
def test_units_of_the_unknowns_do_not_matter(rng, backend: str) -> None:
    units = 10.0 ** rng.uniform(-9, 9, size=162)
    A = sp.csc_array(sp.diags_array(units) @ screened() @ sp.diags_array(units))
    A = (A + A.T) / 2
    x = rng.normal(size=162)
    found = units * SparseCholesky(A, backend).solve(A @ (x / units))
    assert_allclose(found, x, rtol=0, atol=1e-11)


@pytest.mark.parametrize(
    ("A", "message"),
    [
        (np.ones((2, 3)), r"A must be square, got shape \(2, 3\)"),
        (np.zeros((0, 0)), "A must have at least one row"),
        (np.array([[1.0, 0.5], [0, 1]]), r"A must be symmetric, got \|A - A\^T\| up to 0.5"),
        (np.array([[np.nan, 0], [0, 1]]), "A must be finite, found NaN"),
        (np.array([[np.inf, 0], [0, 1]]), "A must be finite"),
    ],
)
def test_what_is_no_symmetric_matrix_is_refused(A: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SparseCholesky(sp.csc_array(A))


def test_an_unknown_backend_is_refused() -> None:
    with pytest.raises(ValueError, match="backend must be 'numba', 'splu' or 'cholespy', got 'magic'"):
        SparseCholesky(screened(), "magic")  # type: ignore[arg-type]


@pytest.mark.parametrize("shape", [(161,), (163, 2), (162, 1, 1), ()])
def test_sides_of_another_length_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"b must have shape \(162,\) or \(162, k\), got"):
        SparseCholesky(screened()).solve(np.zeros(shape))


def test_without_cholespy_the_message_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ImportError, match="pip install cholespy"):
        SparseCholesky(screened(), "cholespy")
