"""Nested dissection: a permutation, whose factor is sparse."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from linalg_graphs import GRAPHS, grid, path
from numpy.testing import assert_array_equal

from tempose.linalg.ordering import LEAF, nested_dissection
from tempose.linalg.symbolic import column_counts, elimination_tree


def fill(A: sp.csr_array, order: np.ndarray) -> int:
    B = sp.csr_array(A[order][:, order])
    return int(column_counts(B.indptr, B.indices, elimination_tree(B.indptr, B.indices)).sum())


@pytest.mark.parametrize("name", GRAPHS)
def test_every_unknown_is_eliminated_once(name: str) -> None:
    A = GRAPHS[name]()
    assert_array_equal(np.sort(nested_dissection(A)), np.arange(A.shape[0]))


def test_the_same_matrix_gives_the_same_order() -> None:
    assert_array_equal(nested_dissection(grid(30, 30)), nested_dissection(grid(30, 30)))


def test_a_path_fills_in_next_to_nothing() -> None:
    A = path(5000)
    # besides itself an unknown reaches at most the two separators that bound its part
    assert fill(A, nested_dissection(A)) < 3 * A.shape[0]


@pytest.mark.parametrize("side", [40, 80])
def test_a_grid_fills_in_as_n_log_n(side: int) -> None:
    A, n = grid(side, side), side * side
    found = fill(A, nested_dissection(A))
    assert found < 3.1 * n * np.log2(n)
    # the natural order has a band as wide as the grid
    assert found < 0.6 * fill(A, np.arange(n)) or side == 40


def test_separators_part_what_comes_before_them() -> None:
    """Eliminated last are few unknowns, without which the grid falls apart into halves of some size."""
    A = grid(40, 40)
    order = nested_dissection(A)
    for count in range(30, 60):
        rest = order[:-count]
        labels = sp.csgraph.connected_components(A[rest][:, rest], directed=False)[1]
        if np.bincount(labels).max() < 0.75 * A.shape[0]:
            return
    raise AssertionError("the last 60 unknowns separate nothing")


def test_small_matrices_are_ordered_by_minimum_degree() -> None:
    A = GRAPHS["star"]()[:LEAF][:, :LEAF]
    # the hub of a star goes when one ray is left beside it
    assert list(nested_dissection(sp.csr_array(A))).index(0) >= LEAF - 2
