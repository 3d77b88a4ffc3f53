"""Harmonic fields: mean values, maximum principle, what marks prescribe."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.testing import assert_allclose, assert_array_equal

from tempose.geometry import edge_laplacian
from tempose.transfer.solver import fields
from tempose.transfer.solver.fields import HarmonicFields


def path(n: int) -> sp.csr_array:
    i = np.arange(n - 1)
    return edge_laplacian(np.c_[i, i + 1], np.ones(n - 1), n)


def test_on_a_path_values_lie_on_a_line() -> None:
    W = HarmonicFields(path(11), [0, 10], [0, 1], 2).basis
    s = np.linspace(0, 1, 11)
    assert_allclose(W, np.c_[1 - s, s], rtol=0, atol=1e-14)


def test_springs_in_series_divide_by_their_resistance() -> None:
    weights = np.array([1.0, 4.0, 0.5])
    L = edge_laplacian(np.array([[0, 1], [1, 2], [2, 3]]), weights, 4)
    W = HarmonicFields(L, [0, 3], [0, 1], 2).basis
    assert_allclose(W[:, 1], np.r_[0, np.cumsum(1 / weights)] / (1 / weights).sum(), rtol=0, atol=1e-14)


def test_a_vertex_with_several_marks_takes_their_mean() -> None:
    harmonic = HarmonicFields(path(5), [0, 4, 4, 4], [0, 1, 1, 2], 3)
    assert_allclose(harmonic.basis[4], [0, 2 / 3, 1 / 3], rtol=0, atol=1e-15)
    assert_allclose(harmonic.basis[2], [1 / 2, 1 / 3, 1 / 6], rtol=0, atol=1e-14)


def test_marks_are_exact_whatever_is_asked(rng) -> None:
    harmonic = HarmonicFields(path(9), [2, 6], [1, 0], 2)
    values = rng.normal(size=(2, 7))
    spread = harmonic.interpolate(values)
    assert_array_equal(spread[[2, 6]], values[[1, 0]])
    # beyond the last mark nothing changes any more
    assert_allclose(spread[:2], spread[[2, 2]], rtol=0, atol=1e-14)


def test_a_rotation_without_marks_has_no_influence(rng) -> None:
    harmonic = HarmonicFields(path(5), [0, 4], [0, 2], 3)
    assert_array_equal(harmonic.basis[:, 1], 0)


def test_everything_marked_leaves_nothing_to_solve(rng) -> None:
    columns = rng.integers(3, size=6)
    harmonic = HarmonicFields(path(6), np.arange(6), columns, 3)
    assert_array_equal(harmonic.basis, np.eye(3)[columns])


@pytest.mark.parametrize("limit", [0, 256])
def test_with_and_without_a_kept_basis(limit: int, monkeypatch, rng) -> None:
    A = rng.random((30, 30))
    i, j = np.nonzero(np.triu(A > 0.7, 1))
    i, j = np.r_[i, np.arange(29)], np.r_[j, np.arange(1, 30)]
    L = edge_laplacian(np.c_[i, j], rng.random(len(i)) + 0.1, 30)
    vertices, columns = np.array([3, 8, 8, 20]), np.array([0, 1, 2, 2])
    monkeypatch.setattr(fields, "DENSE_COLUMNS", limit)
    harmonic = HarmonicFields(L, vertices, columns, 3)
    assert (harmonic.basis is None) == (limit == 0)
    Q = rng.normal(size=(3, 8))
    dense = L.toarray()
    dense[[3, 8, 20]] = np.eye(30)[[3, 8, 20]]
    right = np.zeros((30, 8))
    right[[3, 8, 20]] = Q[0], (Q[1] + Q[2]) / 2, Q[2]
    assert_allclose(harmonic.interpolate(Q), np.linalg.solve(dense, right), rtol=0, atol=1e-12)


def test_no_marks_are_refused() -> None:
    with pytest.raises(ValueError, match="must mark at least one face of the target, got none"):
        HarmonicFields(path(4), np.zeros(0, int), np.zeros(0, int), 1)


def test_a_component_without_a_mark_is_refused() -> None:
    L = sp.block_diag([path(3), path(3)]).tocsr()
    with pytest.raises(ValueError, match="hold at least one vertex of every connected component"):
        HarmonicFields(L, [0], [0], 1)
