"""The block factor and its solves against dense ones."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from linalg_graphs import GRAPHS, grid
from numpy.testing import assert_allclose, assert_array_equal

from tempose.linalg.block_factor import BlockFactor, block_factor


def assembled(factor: BlockFactor) -> np.ndarray:
    """``L D L^T`` from the blocks, in the order of the unknowns."""
    n = len(factor.permutation)
    L, D = np.eye(n + 1), np.zeros((n, n))
    for s in range(len(factor.below)):
        a, b = factor.first[s], factor.first[s + 1]
        blocks = factor.blocks[factor.place[s] : factor.place[s + 1]].reshape(-1, b - a)
        D[a:b, a:b] = np.linalg.inv(blocks[: b - a])
        panel = blocks[factor.below[s] - factor.own[s] :]
        np.add.at(L[:, a:b], factor.rows[factor.below[s] : factor.own[s + 1]], -panel)
    L = L[:n, :n]
    return (L @ D @ L.T)[np.ix_(factor.permutation, factor.permutation)]


@pytest.mark.parametrize("name", GRAPHS)
def test_the_factor_multiplies_to_the_matrix(name: str) -> None:
    A = GRAPHS[name]()
    assert_allclose(assembled(block_factor(A)), A.toarray(), rtol=0, atol=1e-11 * abs(A).max())


@pytest.mark.parametrize("name", GRAPHS)
def test_any_order_gives_the_same_answer(name: str, rng) -> None:
    A = GRAPHS[name]()
    n = A.shape[0]
    b = rng.normal(size=(n, 2))
    expected = np.linalg.solve(A.toarray(), b)
    for order in (None, np.arange(n), rng.permutation(n)):
        assert_allclose(block_factor(A, order).solve(b), expected, rtol=0, atol=1e-10)


@pytest.mark.parametrize("k", [1, 3, 4, 5, 8, 47, 48, 49, 100])
def test_sides_in_any_number_are_solved_one_like_the_other(k: int, rng) -> None:
    A = grid(20, 21)
    factor, b = block_factor(A), rng.normal(size=(A.shape[0], k))
    x = factor.solve(b)
    assert_allclose(A @ x, b, rtol=0, atol=1e-12)
    for c in range(k):
        assert_allclose(factor.solve(b[:, [c]])[:, 0], x[:, c], rtol=0, atol=1e-14)


@pytest.mark.parametrize("k", [4, 8, 48])
def test_the_spare_row_stays_zero(k: int, rng) -> None:
    A = grid(15, 15)
    factor = block_factor(A)
    X = np.zeros((A.shape[0] + 1, k))
    X[:-1] = rng.normal(size=(A.shape[0], k))
    factor.solve_rows(X)
    assert_array_equal(X[-1], 0)


@pytest.mark.parametrize("side", [10, 30, 100])
def test_single_precision_is_what_its_condition_allows(side: int, rng) -> None:
    """Errors relative to the answer stay below a small multiple of rounding times the condition number."""
    A = grid(side, side, 1e-3)
    condition = 14.0 / 1e-3
    x = rng.normal(size=(A.shape[0], 3))
    found = block_factor(A).astype(np.float32).solve(A @ x)
    assert np.linalg.norm(found - x) < 0.2 * condition * np.finfo(np.float32).eps * np.linalg.norm(x)


def test_wide_fronts_are_factored_in_several_panels(rng) -> None:
    B = rng.normal(size=(700, 700))
    A = B @ B.T + 700 * np.eye(700)
    factor = block_factor(sp.csr_array(A))
    assert len(factor.below) > 3
    x = rng.normal(size=(700, 5))
    assert_allclose(factor.solve(A @ x), x, rtol=0, atol=1e-12)


def test_the_least_pivot_tells_how_singular_a_matrix_is() -> None:
    for shift in (1e-4, 1e-6, 1e-8):
        # whatever the order, the last pivot is about n times the shift, and degrees are 2 to 6
        assert 64 * shift / 7 < block_factor(grid(8, 8, shift)).least_pivot < 64 * shift / 1.9
    assert not block_factor(sp.csr_array(np.array([[1.0, 2], [2, 1]]))).least_pivot > 0
