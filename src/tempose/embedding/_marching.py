"""Distances inside a solid by fast marching (Sethian 1996)."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True, nogil=True)
def _sift_up(keys: FloatArray, cells: IntArray, at: int) -> None:
    key, cell = keys[at], cells[at]
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] <= key:
            break
        keys[at], cells[at] = keys[above], cells[above]
        at = above
    keys[at], cells[at] = key, cell


@njit(cache=True, nogil=True)
def _sift_down(keys: FloatArray, cells: IntArray, size: int) -> None:
    key, cell = keys[0], cells[0]
    at = 0
    while True:
        child = 2 * at + 1
        if child >= size:
            break
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[at], cells[at] = keys[child], cells[child]
        at = child
    keys[at], cells[at] = key, cell


@njit(cache=True, nogil=True)
def _eikonal(a: float, b: float, c: float) -> float:
    # a, b, c: least known neighbour along each axis; the largest that exceeds the solution drops out
    if a > b:
        a, b = b, a
    if b > c:
        b, c = c, b
    if a > b:
        a, b = b, a
    t = a + 1.0
    if t <= b:
        return t
    t = 0.5 * (a + b + np.sqrt(max(2.0 - (a - b) ** 2, 0.0)))
    if t <= c:
        return t
    s = a + b + c
    return (s + np.sqrt(max(s * s - 3.0 * (a * a + b * b + c * c - 1.0), 0.0))) / 3.0


@njit(cache=True, nogil=True)
def _lower(D: FloatArray, before: int, after: int) -> float:
    low = D[before] if before >= 0 else np.inf
    return min(low, D[after]) if after >= 0 else low


@njit(cache=True, nogil=True)
def march(neighbours: IntArray, seeds: IntArray, start: FloatArray) -> FloatArray:
    """Distance from seeds through a set of cells.

    Parameters
    ----------
    neighbours : (N, 6) int
        Of N cells, those along -x, +x, -y, +y, -z, +z; -1 where there is none.
    seeds : (s,) int
        Cells at which the distance is known.
    start : (s,) float
        Distance there, in cells.

    Returns
    -------
    (N,) ndarray
        Distance in cells; infinite where no way leads.
    """
    N = len(neighbours)
    D = np.full(N, np.inf)
    done = np.zeros(N, dtype=np.bool_)
    capacity = 6 * N + len(seeds) + 1
    keys, cells = np.zeros(capacity), np.zeros(capacity, dtype=np.int32)
    size = 0
    for s in range(len(seeds)):
        D[seeds[s]] = min(D[seeds[s]], start[s])
        keys[size], cells[size] = start[s], seeds[s]
        size += 1
        _sift_up(keys, cells, size - 1)
    while size > 0:
        cell = cells[0]
        size -= 1
        keys[0], cells[0] = keys[size], cells[size]
        if size > 0:
            _sift_down(keys, cells, size)
        if done[cell]:
            continue
        done[cell] = True
        for d in range(6):
            other = neighbours[cell, d]
            if other < 0 or done[other]:
                continue
            t = _eikonal(
                _lower(D, neighbours[other, 0], neighbours[other, 1]),
                _lower(D, neighbours[other, 2], neighbours[other, 3]),
                _lower(D, neighbours[other, 4], neighbours[other, 5]),
            )
            if t < D[other]:
                D[other] = t
                keys[size], cells[size] = t, other
                size += 1
                _sift_up(keys, cells, size - 1)
    return D
