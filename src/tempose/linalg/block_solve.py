"""Solves with a block factor, vectorised across right-hand sides.

A factor ``L D L^T`` has, for every supernode s of columns ``first[s]`` to ``first[s + 1]``, a list of rows:
from ``own[s]`` on its own columns, from ``below[s]`` on those of its panel. Both lists are filled up to fours
with the row n, which stands for nothing. In `blocks` lie, row by row, the inverse of the diagonal block and
the panel, the panel negative.
"""

from __future__ import annotations

from typing import Any

import numba

from tempose.linalg.lanes import alike, item, load4, load8, plus_times, scaled, store


@numba.njit(cache=True, nogil=True)
def forward_4(
    first: Any, own: Any, below: Any, rows: Any, place: Any, blocks: Any, X: Any, lo: Any, hi: Any
) -> None:
    """Solve ``L Y = X`` in place for four right-hand sides, supernodes `lo` to `hi`.

    Parameters
    ----------
    first, own, below, rows, place, blocks : ndarray
        The factor.
    X : (4 (n + 1),) ndarray
        Rows of four sides, the last row zero.
    lo, hi : int
        First supernode and the one after the last.
    """
    for s in range(lo, hi):
        w, begin = first[s + 1] - first[s], 4 * first[s]
        at = place[s] + (below[s] - own[s]) * w
        for r in range(below[s], own[s + 1], 4):
            i0, i1, i2, i3 = 4 * rows[r], 4 * rows[r + 1], 4 * rows[r + 2], 4 * rows[r + 3]
            y0, y1, y2, y3 = load4(X, i0), load4(X, i1), load4(X, i2), load4(X, i3)
            for j in range(w):
                x = load4(X, begin + 4 * j)
                y0 = plus_times(y0, item(blocks, at + j), x)
                y1 = plus_times(y1, item(blocks, at + w + j), x)
                y2 = plus_times(y2, item(blocks, at + 2 * w + j), x)
                y3 = plus_times(y3, item(blocks, at + 3 * w + j), x)
            store(X, i0, y0)
            store(X, i1, y1)
            store(X, i2, y2)
            store(X, i3, y3)
            at += 4 * w


@numba.njit(cache=True, nogil=True)
def backward_4(
    first: Any, own: Any, below: Any, rows: Any, place: Any, blocks: Any, X: Any, T: Any, lo: Any, hi: Any
) -> None:
    """Solve ``D L^T Y = X`` in place for four right-hand sides, supernodes `hi` down to `lo`.

    Parameters
    ----------
    first, own, below, rows, place, blocks : ndarray
        The factor.
    X : (4 (n + 1),) ndarray
        Rows of four sides, the last row zero.
    T : (4 w,) ndarray
        Scratch for the widest supernode.
    lo, hi : int
        First supernode and the one after the last.
    """
    for s in range(hi - 1, lo - 1, -1):
        w, begin, at = first[s + 1] - first[s], 4 * first[s], place[s]
        nothing = alike(load4(T, 0), T.dtype.type(0.0))
        for j in range(w):
            store(T, 4 * j, nothing)
        for r in range(own[s], own[s + 1], 4):
            x0, x1 = load4(X, 4 * rows[r]), load4(X, 4 * rows[r + 1])
            x2, x3 = load4(X, 4 * rows[r + 2]), load4(X, 4 * rows[r + 3])
            for j in range(w):
                # summed apart from T, so that no row waits for the one before
                y = scaled(item(blocks, at + j), x0)
                y = plus_times(y, item(blocks, at + w + j), x1)
                y = plus_times(y, item(blocks, at + 2 * w + j), x2)
                y = plus_times(y, item(blocks, at + 3 * w + j), x3)
                store(T, 4 * j, load4(T, 4 * j) + y)
            at += 4 * w
        for j in range(w):
            store(X, begin + 4 * j, load4(T, 4 * j))


@numba.njit(cache=True, nogil=True)
def solve_8(
    first: Any, own: Any, below: Any, rows: Any, place: Any, blocks: Any, X: Any, T: Any, k: Any
) -> None:
    """Solve ``L D L^T Y = X`` in place for k right-hand sides, k a multiple of eight.

    Parameters
    ----------
    first, own, below, rows, place, blocks : ndarray
        The factor.
    X : (k (n + 1),) ndarray
        Rows of k sides, the last row zero.
    T : (k w,) ndarray
        Scratch for the widest supernode.
    k : int
        Number of right-hand sides.
    """
    count = len(first) - 1
    for s in range(count):
        w, begin = first[s + 1] - first[s], k * first[s]
        at = place[s] + (below[s] - own[s]) * w
        # eight sides of all columns side by side: the inner loop then walks through a few kilobytes
        for j in range(w):
            for c in range(0, k, 8):
                store(T, c * w + 8 * j, load8(X, begin + k * j + c))
        for r in range(below[s], own[s + 1], 4):
            i0, i1, i2, i3 = k * rows[r], k * rows[r + 1], k * rows[r + 2], k * rows[r + 3]
            for c in range(0, k, 8):
                y0, y1, y2, y3 = load8(X, i0 + c), load8(X, i1 + c), load8(X, i2 + c), load8(X, i3 + c)
                for j in range(w):
                    x = load8(T, c * w + 8 * j)
                    y0 = plus_times(y0, item(blocks, at + j), x)
                    y1 = plus_times(y1, item(blocks, at + w + j), x)
                    y2 = plus_times(y2, item(blocks, at + 2 * w + j), x)
                    y3 = plus_times(y3, item(blocks, at + 3 * w + j), x)
                store(X, i0 + c, y0)
                store(X, i1 + c, y1)
                store(X, i2 + c, y2)
                store(X, i3 + c, y3)
            at += 4 * w
    nothing = alike(load8(T, 0), T.dtype.type(0.0))
    for s in range(count - 1, -1, -1):
        w, begin, at = first[s + 1] - first[s], k * first[s], place[s]
        for j in range(0, k * w, 8):
            store(T, j, nothing)
        for r in range(own[s], own[s + 1], 4):
            i0, i1, i2, i3 = k * rows[r], k * rows[r + 1], k * rows[r + 2], k * rows[r + 3]
            for c in range(0, k, 8):
                x0, x1, x2, x3 = load8(X, i0 + c), load8(X, i1 + c), load8(X, i2 + c), load8(X, i3 + c)
                for j in range(w):
                    y = scaled(item(blocks, at + j), x0)
                    y = plus_times(y, item(blocks, at + w + j), x1)
                    y = plus_times(y, item(blocks, at + 2 * w + j), x2)
                    y = plus_times(y, item(blocks, at + 3 * w + j), x3)
                    store(T, c * w + 8 * j, load8(T, c * w + 8 * j) + y)
            at += 4 * w
        for j in range(w):
            for c in range(0, k, 8):
                store(X, begin + k * j + c, load8(T, c * w + 8 * j))
