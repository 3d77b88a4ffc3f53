"""Where a Cholesky factor has entries: elimination tree, column counts, supernodes."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

SPARE = 24
"""Columns are joined to one supernode if that stores at most so many zeros, or so small a share of them."""
SPARE_SHARE = 0.08
WIDEST = 128
"""Columns of a supernode at most: what its inverted diagonal block costs grows with the cube."""


@numba.njit(cache=True, nogil=True)
def elimination_tree(indptr: Any, indices: Any) -> Any:
    """Find the parent of every column: the first entry below its diagonal.

    Parameters
    ----------
    indptr, indices : (n + 1,), (z,) ndarray of int
        Symmetric pattern, both triangles.

    Returns
    -------
    (n,) ndarray of int
        Parents, -1 at the roots.
    """
    n = len(indptr) - 1
    parent, ancestor = np.full(n, -1), np.full(n, -1)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            while i != -1 and i < j:
                above = ancestor[i]
                ancestor[i] = j
                if above == -1:
                    parent[i] = j
                i = above
    return parent


@numba.njit(cache=True, nogil=True)
def column_counts(indptr: Any, indices: Any, parent: Any) -> Any:
    """Count the entries of every column of the factor, the diagonal included.

    Parameters
    ----------
    indptr, indices : (n + 1,), (z,) ndarray of int
        Symmetric pattern, both triangles.
    parent : (n,) ndarray of int
        Elimination tree.

    Returns
    -------
    (n,) ndarray of int
        Counts.
    """
    n = len(parent)
    counts, seen = np.ones(n, dtype=np.int64), np.full(n, -1)
    for i in range(n):
        seen[i] = i
        for p in range(indptr[i], indptr[i + 1]):
            k = indices[p]
            # row i of the factor is the part of the tree between these entries and i
            while k < i and seen[k] != i:
                counts[k] += 1
                seen[k] = i
                k = parent[k]
    return counts


@numba.njit(cache=True, nogil=True)
def postorder(parent: Any) -> Any:
    """Order a forest so that every subtree is contiguous and children come before parents.

    Parameters
    ----------
    parent : (n,) ndarray of int
        Elimination tree.

    Returns
    -------
    (n,) ndarray of int
        Columns in postorder.
    """
    n = len(parent)
    head, following = np.full(n + 1, -1), np.full(n, -1)
    for j in range(n - 1, -1, -1):
        following[j] = head[parent[j]]
        head[parent[j]] = j
    order, stack = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
    count, root = 0, head[-1]
    while root != -1:
        top = 0
        stack[0] = root
        while top >= 0:
            j = stack[top]
            child = head[j]
            if child == -1:
                order[count] = j
                count += 1
                top -= 1
            else:
                head[j] = following[child]
                top += 1
                stack[top] = child
        root = following[root]
    return order


@numba.njit(cache=True, nogil=True)
def supernodes(parent: Any, counts: Any) -> Any:
    """Group columns of (nearly) the same pattern.

    Parameters
    ----------
    parent : (n,) ndarray of int
        Elimination tree in postorder.
    counts : (n,) ndarray of int
        Entries of each column.

    Returns
    -------
    (s + 1,) ndarray of int
        First column of every supernode, then n.
    """
    n = len(parent)
    first, zeros = np.zeros(n + 1, dtype=np.int64), np.zeros(n, dtype=np.int64)
    s = 0
    for j in range(n):
        end = j + 1
        first[s], zeros[s] = j, 0
        # a column joins the supernode before it where that hangs on it
        while s > 0 and first[s] <= parent[first[s] - 1] < end:
            below = counts[j] - 1
            w1, w2 = first[s] - first[s - 1], end - first[s]
            spare = zeros[s - 1] + zeros[s] + w1 * (below + w2 - (counts[first[s] - 1] - 1))
            width = w1 + w2
            if width > WIDEST or spare > max(SPARE, SPARE_SHARE * width * (below + 0.5 * width)):
                break
            s -= 1
            zeros[s] = spare
        s += 1
    first[s] = n
    return first[: s + 1].copy()


@numba.njit(cache=True, nogil=True)
def supernode_rows(indptr: Any, indices: Any, counts: Any, first: Any) -> Any:
    """Collect the rows below the diagonal block of every supernode.

    Parameters
    ----------
    indptr, indices : (n + 1,), (z,) ndarray of int
        Symmetric pattern, both triangles.
    counts : (n,) ndarray of int
        Entries of each column.
    first : (s + 1,) ndarray of int
        First column of every supernode.

    Returns
    -------
    start : (s + 1,) ndarray of int
        Where the rows of each supernode begin.
    rows : (start[-1],) ndarray of int
        Row indices, ascending within a supernode.
    above : (s,) ndarray of int
        Parent of each supernode, -1 at roots.
    """
    n, k = len(counts), len(first) - 1
    owner, start = np.zeros(n, dtype=np.int64), np.zeros(k + 1, dtype=np.int64)
    for s in range(k):
        owner[first[s] : first[s + 1]] = s
        start[s + 1] = start[s] + counts[first[s + 1] - 1] - 1
    rows = np.zeros(start[k], dtype=np.int32)
    above, head, following = np.full(k, -1), np.full(k, -1), np.full(k, -1)
    seen = np.full(n, -1)
    for s in range(k):
        end, at = first[s + 1], start[s]
        for p in range(indptr[first[s]], indptr[end]):
            i = indices[p]
            if i >= end and seen[i] != s:
                seen[i], rows[at] = s, i
                at += 1
        child = head[s]
        while child != -1:
            for p in range(start[child], start[child + 1]):
                i = rows[p]
                if i >= end and seen[i] != s:
                    seen[i], rows[at] = s, i
                    at += 1
            child = following[child]
        mine = rows[start[s] : start[s + 1]]
        mine.sort()
        if len(mine) > 0:
            t = owner[mine[0]]
            above[s], following[s], head[t] = t, head[t], s
    return start, rows, above


@numba.njit(cache=True, nogil=True)
def padded_rows(first: Any, start: Any, rows: Any) -> Any:
    """Lay out the blocks of every supernode, rows in fours.

    Parameters
    ----------
    first : (s + 1,) ndarray of int
        First column of every supernode.
    start, rows : ndarray of int
        Rows below each diagonal block, see `supernode_rows`.

    Returns
    -------
    own : (s + 1,) ndarray of int
        Where the rows of each supernode begin: its own columns, filled up to a multiple of four by the row n.
    below : (s,) ndarray of int
        Where its rows below begin, filled up likewise.
    padded : (own[-1],) ndarray of int
        The rows.
    place : (s + 1,) ndarray of int
        Where its blocks begin.
    """
    k = len(first) - 1
    own, below, place = (
        np.zeros(k + 1, dtype=np.int64),
        np.zeros(k, dtype=np.int64),
        np.zeros(k + 1, dtype=np.int64),
    )
    for s in range(k):
        w, m = first[s + 1] - first[s], start[s + 1] - start[s]
        below[s] = own[s] + (w + 3) // 4 * 4
        own[s + 1] = below[s] + (m + 3) // 4 * 4
        place[s + 1] = place[s] + w * (own[s + 1] - own[s])
    padded = np.full(own[k], first[k], dtype=np.int32)
    for s in range(k):
        for j in range(first[s + 1] - first[s]):
            padded[own[s] + j] = first[s] + j
        padded[below[s] : below[s] + start[s + 1] - start[s]] = rows[start[s] : start[s + 1]]
    return own, below, padded, place
