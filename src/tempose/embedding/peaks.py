"""Peaks of a function on cells, and where they join: the merge tree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from tempose.typing import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class MergeTree:
    """The P peaks of a function and where each joins a higher one, the most prominent first."""

    peaks: IntArray
    """(P,) cell of each peak."""
    saddles: IntArray
    """(P,) cell at which, going down, it joins a higher one; -1 for the highest."""
    into: IntArray
    """(P,) peak cell that it joins; -1 for the highest."""
    prominence: FloatArray
    """(P,) height of the peak above its saddle; of the highest, above the lowest cell."""


def merge_tree(values: FloatArray, neighbours: IntArray) -> MergeTree:
    """Find the peaks of a function by going down through its values.

    Parameters
    ----------
    values : (N,) float
        Function on N cells, finite.
    neighbours : (N, k) int
        Cells beside each; -1 where there is none.

    Returns
    -------
    MergeTree
        Every peak.
    """
    order = np.argsort(-values, kind="stable")
    peak_of, saddle, into = _sweep(order, neighbours)
    peaks = np.flatnonzero(peak_of == np.arange(len(values)))
    low = np.where(saddle[peaks] >= 0, values[saddle[peaks]], values.min())
    prominence = values[peaks] - low
    rank = np.argsort(-prominence, kind="stable")
    peaks = peaks[rank]
    return MergeTree(peaks, saddle[peaks], into[peaks], prominence[rank])


@njit(cache=True, nogil=True)
def _find(parent: IntArray, i: int) -> int:
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@njit(cache=True, nogil=True)
def _sweep(order: IntArray, neighbours: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    N = len(order)
    parent = np.full(N, -1)
    rank = np.zeros(N, dtype=np.int64)
    for i in range(N):
        rank[order[i]] = i
    # the root of every set is its peak, so a set is older when its root comes earlier in the order
    first = np.full(N, -1)
    saddle, into = np.full(N, -1), np.full(N, -1)
    for i in range(N):
        cell = order[i]
        parent[cell] = cell
        first[cell] = cell
        for d in range(neighbours.shape[1]):
            other = neighbours[cell, d]
            if other < 0 or parent[other] < 0:
                continue
            a, b = _find(parent, cell), _find(parent, other)
            if a == b:
                continue
            if rank[a] > rank[b]:
                a, b = b, a
            parent[b] = a
            if b == cell:
                first[cell] = a
            else:
                saddle[b], into[b] = cell, a
    return first, saddle, into


def join_cell(values: FloatArray, neighbours: IntArray, a: int, b: int) -> int:
    """Lowest cell that a way from one cell to another cannot avoid.

    Parameters
    ----------
    values : (N,) float
        Function on N cells.
    neighbours : (N, k) int
        Cells beside each; -1 where there is none.
    a, b : int
        Two cells.

    Returns
    -------
    int
        The cell at which their regions above a falling level first meet; -1 if they never do.
    """
    return int(_join(np.argsort(-values, kind="stable"), neighbours, a, b))


@njit(cache=True, nogil=True)
def _join(order: IntArray, neighbours: IntArray, a: int, b: int) -> int:
    parent = np.full(len(order), -1)
    for cell in order:
        parent[cell] = cell
        for d in range(neighbours.shape[1]):
            other = neighbours[cell, d]
            if other >= 0 and parent[other] >= 0:
                parent[_find(parent, other)] = _find(parent, cell)
        if parent[a] >= 0 and parent[b] >= 0 and _find(parent, a) == _find(parent, b):
            return cell
    return -1


@njit(cache=True, nogil=True)
def flood(allowed: BoolArray, neighbours: IntArray, seed: int) -> BoolArray:
    """Mark the cells that can be reached.

    Parameters
    ----------
    allowed : (N,) bool
        Cells that may be entered.
    neighbours : (N, k) int
        Cells beside each; -1 where there is none.
    seed : int
        Where to start; it counts as allowed.

    Returns
    -------
    (N,) ndarray of bool
        Cells reached.
    """
    reached = np.zeros(len(allowed), dtype=np.bool_)
    stack = np.zeros(len(allowed), dtype=np.int64)
    stack[0], size = seed, 1
    reached[seed] = True
    while size > 0:
        size -= 1
        cell = stack[size]
        for d in range(neighbours.shape[1]):
            other = neighbours[cell, d]
            if other >= 0 and allowed[other] and not reached[other]:
                reached[other] = True
                stack[size] = other
                size += 1
    return reached
