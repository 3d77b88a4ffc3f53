"""Structure of the factor, against the dense factor."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import scipy.sparse as sp
from linalg_graphs import GRAPHS
from numpy.testing import assert_array_equal

from tempose.linalg.symbolic import (
    WIDEST,
    column_counts,
    elimination_tree,
    padded_rows,
    postorder,
    supernode_rows,
    supernodes,
)


def slow_pattern(A: sp.csr_array) -> np.ndarray:
    """Pattern of the factor by elimination of a graph."""
    P = A.toarray() != 0
    for j in range(len(P)):
        below = j + 1 + np.flatnonzero(P[j + 1 :, j])
        P[np.ix_(below, below)] = True
    return np.tril(P)


def in_postorder(A: sp.csr_array) -> sp.csr_array:
    order = postorder(elimination_tree(A.indptr, A.indices))
    B = sp.csr_array(A[order][:, order])
    B.sort_indices()
    return B


@pytest.mark.parametrize("name", GRAPHS)
def test_tree_and_counts_are_those_of_the_dense_factor(name: str) -> None:
    A = GRAPHS[name]()
    P = slow_pattern(A)
    parent = elimination_tree(A.indptr, A.indices)
    for j in range(len(P)):
        below = np.flatnonzero(P[j + 1 :, j])
        assert parent[j] == (j + 1 + below[0] if len(below) else -1)
    assert_array_equal(column_counts(A.indptr, A.indices, parent), P.sum(axis=0))


@pytest.mark.parametrize("name", GRAPHS)
def test_postorder_keeps_subtrees_together_and_children_first(name: str) -> None:
    A = GRAPHS[name]()
    parent = elimination_tree(A.indptr, A.indices)
    order = postorder(parent)
    assert_array_equal(np.sort(order), np.arange(len(parent)))
    place = np.argsort(order)
    size = np.ones(len(parent), dtype=int)
    for j in order:
        if parent[j] >= 0:
            assert place[j] < place[parent[j]]
            size[parent[j]] += size[j]
    for j in range(len(parent)):
        if parent[j] >= 0:
            assert place[j] > place[parent[j]] - size[parent[j]]


@pytest.mark.parametrize("name", GRAPHS)
def test_supernodes_cover_the_factor_and_little_else(name: str) -> None:
    A = in_postorder(GRAPHS[name]())
    P = slow_pattern(A)
    parent = elimination_tree(A.indptr, A.indices)
    counts = column_counts(A.indptr, A.indices, parent)
    first = supernodes(parent, counts)
    start, rows, above = supernode_rows(A.indptr, A.indices, counts, first)
    assert first[0] == 0 and first[-1] == len(P) and (np.diff(first) > 0).all()
    assert np.diff(first).max() <= WIDEST
    stored = np.zeros_like(P)
    for s, (a, b) in enumerate(pairwise(first)):
        mine = rows[start[s] : start[s + 1]]
        assert (np.diff(mine) > 0).all() and (mine >= b).all()
        stored[a:b, a:b] = np.tri(b - a, dtype=bool)
        stored[np.ix_(mine, range(a, b))] = True
        owner = np.searchsorted(first, mine[0], side="right") - 1 if len(mine) else -1
        assert above[s] == owner
    assert not (P & ~stored).any()
    assert stored.sum() <= 1.1 * P.sum() + 24 * (len(first) - 1)


def test_rows_are_filled_up_to_fours_by_the_row_after_the_last() -> None:
    A = in_postorder(GRAPHS["grid"]())
    counts = column_counts(A.indptr, A.indices, elimination_tree(A.indptr, A.indices))
    first = supernodes(elimination_tree(A.indptr, A.indices), counts)
    start, rows, _ = supernode_rows(A.indptr, A.indices, counts, first)
    own, below, padded, place = padded_rows(first, start, rows)
    assert (own % 4 == 0).all() and (below % 4 == 0).all()
    for s in range(len(below)):
        w, m = first[s + 1] - first[s], start[s + 1] - start[s]
        assert_array_equal(padded[own[s] : own[s] + w], np.arange(first[s], first[s + 1]))
        assert_array_equal(padded[below[s] : below[s] + m], rows[start[s] : start[s + 1]])
        assert (padded[own[s] + w : below[s]] == first[-1]).all()
        assert (padded[below[s] + m : own[s + 1]] == first[-1]).all()
        assert place[s + 1] - place[s] == w * (own[s + 1] - own[s])
