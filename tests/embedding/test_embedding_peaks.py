"""Peaks, joins and floods agree with what thresholds and labels say."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tempose.embedding.peaks import flood, join_cell, merge_tree


def grid_neighbours(shape: tuple[int, int]) -> np.ndarray:
    number = np.arange(np.prod(shape)).reshape(shape)
    padded = np.pad(number, 1, constant_values=-1)
    cut = [padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]]
    return np.column_stack([c.ravel() for c in cut])


def labels_above(values: np.ndarray, beside: np.ndarray, level: float) -> np.ndarray:
    i, way = np.nonzero(beside >= 0)
    j = beside[i, way]
    keep = (values[i] >= level) & (values[j] >= level)
    graph = coo_array((np.ones(keep.sum()), (i[keep], j[keep])), shape=(len(values),) * 2)
    return connected_components(graph, directed=False)[1]


@pytest.mark.parametrize("seed", range(5))
def test_peaks_and_saddles_by_thresholds(seed: int) -> None:
    values = np.random.default_rng(seed).permutation(63).astype(float)
    beside = grid_neighbours((7, 9))
    tree = merge_tree(values, beside)
    around = np.where(beside >= 0, values[beside], -1).max(axis=1)
    assert_array_equal(np.sort(tree.peaks), np.flatnonzero(values > around))
    assert tree.saddles[0] == -1 and (np.diff(tree.prominence) <= 0).all()
    for peak, saddle, into in zip(tree.peaks[1:], tree.saddles[1:], tree.into[1:]):
        above = labels_above(values, beside, values[saddle] + 0.5)
        at = labels_above(values, beside, values[saddle])
        assert values[into] > values[peak] == values[above == above[peak]].max()
        assert at[peak] == at[into] and above[peak] != above[into]


@pytest.mark.parametrize("seed", range(5))
def test_join_is_the_highest_level_that_joins(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.permutation(48).astype(float)
    beside = grid_neighbours((6, 8))
    a, b = (int(i) for i in rng.choice(48, 2, replace=False))
    cell = join_cell(values, beside, a, b)
    joined = [v for v in values if (lab := labels_above(values, beside, v))[a] == lab[b]]
    assert values[cell] == max(joined)


def test_cells_that_never_meet_have_no_join() -> None:
    beside = np.full((2, 4), -1)
    assert join_cell(np.arange(2.0), beside, 0, 1) == -1


def test_flood_reaches_the_component(rng: np.random.Generator) -> None:
    allowed = rng.random(99) < 0.6
    seed = int(np.flatnonzero(allowed)[3])
    beside = grid_neighbours((9, 11))
    labels = labels_above(allowed.astype(float), beside, 0.5)
    assert_array_equal(flood(allowed, beside, seed), labels == labels[seed])
