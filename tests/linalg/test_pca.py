"""Components by the Gram matrix are those of the singular value decomposition, down to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.linalg.pca import GramPCA, gram_pca


def rows(n: int, d: int, decay: float = 0.0, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, d)) * np.exp(-decay * np.arange(n))[:, None] + rng.normal(size=d)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(("n", "d"), [(6, 40), (1, 7), (2, 9), (9, 4), (30, 30)])
def test_it_is_the_singular_value_decomposition_about_the_mean(n: int, d: int, unit: float) -> None:
    Z = unit * rows(n, d)
    found = gram_pca(Z)
    s = np.linalg.svd(Z - Z.mean(axis=0), compute_uv=False)
    r = len(found.components)
    assert r == min(n - 1, d)
    assert_allclose(found.singular_values[:r], s[:r], rtol=1e-10)
    assert_allclose(found.mean, Z.mean(axis=0), rtol=1e-12)
    assert_allclose(found.mean + found.coordinates @ found.components, Z, atol=1e-12 * unit * 10)


@pytest.mark.parametrize("decay", [0.0, 0.5, 1.5, 2.5])
def test_components_are_orthonormal_and_span_the_rows_however_steep_the_spectrum(decay: float) -> None:
    Z = rows(12, 50, decay)
    found = gram_pca(Z)
    r = len(found.components)
    assert_allclose(found.components @ found.components.T, np.eye(r), atol=1e-10)
    assert_allclose(found.mean + found.coordinates @ found.components, Z, atol=1e-13)
    gram = found.coordinates.T @ found.coordinates
    assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-10 * gram[0, 0])
    kept = found.singular_values[:r]
    s = np.linalg.svd(Z - Z.mean(axis=0), compute_uv=False)[:r]
    assert_allclose(kept[s > 1e-12 * s[0]], s[s > 1e-12 * s[0]], rtol=1e-3)


def test_small_values_are_known_to_more_than_half_the_digits() -> None:
    Z = rows(8, 60, 2.0)
    s = np.linalg.svd(Z - Z.mean(axis=0), compute_uv=False)
    found = gram_pca(Z).singular_values
    assert_allclose(found[:7], s[:7], rtol=1e-7)
    assert s[6] < 1e-5 * s[0]


@pytest.mark.parametrize("first", ["coordinates", "components", "left_out"])
def test_whatever_is_asked_first_is_sharp(first: str) -> None:
    Z = rows(12, 50, 1.5)
    pca = GramPCA(Z)
    getattr(pca, first)(11)
    X, H = pca.coordinates(11), pca.components(11)
    assert_allclose((Z - Z.mean(axis=0)) @ H.T, X, atol=1e-14)
    fresh = getattr(GramPCA(Z), first)(11)
    assert_allclose(np.abs(fresh), np.abs(getattr(pca, first)(11)), atol=1e-14)


@pytest.mark.parametrize("m", [0, 3, 7, 11])
def test_what_is_left_out_of_each_vector_is_its_distance_to_the_span(m: int) -> None:
    Z = rows(12, 50, 0.8)
    pca = GramPCA(Z)
    left = Z - Z.mean(axis=0) - pca.coordinates(m) @ pca.components(m)
    assert_allclose(GramPCA(Z).left_out(m), np.square(left).sum(axis=1), rtol=1e-6, atol=1e-26)


def test_few_components_leave_out_exactly_the_rest_of_the_spectrum() -> None:
    Z = rows(10, 33)
    found = gram_pca(Z, 4)
    left = Z - found.mean - found.coordinates @ found.components
    assert found.components.shape == (4, 33)
    assert_allclose(np.square(left).sum(), np.square(found.singular_values[4:]).sum(), rtol=1e-12)


def test_repeated_rows_lower_the_rank() -> None:
    Z = rows(5, 20)
    assert GramPCA(np.concatenate([Z, Z])).rank == 4


@pytest.mark.parametrize("offset", [0.0, 1.0, 1e6])
def test_equal_rows_have_no_component(offset: float) -> None:
    Z = np.repeat(rows(1, 20), 7, axis=0) + offset
    found = gram_pca(Z)
    assert found.components.shape == (0, 20) and found.coordinates.shape == (7, 0)
    assert_allclose(found.mean, Z[0], rtol=1e-14)


def test_a_rotation_of_the_rows_turns_the_components() -> None:
    Z = rows(6, 10)
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(10, 10)))[0]
    a, b = gram_pca(Z), gram_pca(Z @ turn)
    assert_allclose(np.abs(a.components @ turn @ b.components.T), np.eye(5), atol=1e-9)


@pytest.mark.parametrize("bad", [np.zeros(3), np.zeros((0, 3)), np.full((2, 3), np.nan)])
def test_what_is_no_list_of_vectors_is_refused(bad: np.ndarray) -> None:
    with pytest.raises(ValueError, match="Z must"):
        gram_pca(bad)


def test_a_negative_number_of_components_is_refused() -> None:
    with pytest.raises(ValueError, match="m must be 0 or more, got -1"):
        gram_pca(rows(3, 4), -1)
