"""Order of elimination by nested dissection: a small separator last, then each side in the same way."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
import scipy.sparse as sp

from tempose.typing import IntArray

LEAF = 32
"""Regions of at most so many vertices are ordered by minimum degree (at most 64: one bit a vertex)."""
SWEEPS = 6
RELAXATION = 1.5
SMALLEST_SIDE = 0.1


def nested_dissection(A: Any) -> IntArray:
    """Order the unknowns of a symmetric sparse matrix so that its Cholesky factor stays sparse.

    Parameters
    ----------
    A : (n, n) sparse array
        Symmetric pattern, both triangles stored; the diagonal is ignored.

    Returns
    -------
    (n,) ndarray of int
        Unknowns in order of elimination.

    Notes
    -----
    A region is cut where a smooth function, larger towards one end of it than towards the other, crosses the
    level with the fewest vertices. After automatic nested dissection [1]_, which cuts at a breadth-first
    level; on surface meshes these cuts are straighter.

    References
    ----------
    .. [1] George, Liu, "An Automatic Nested Dissection Algorithm for Irregular Finite Element Problems",
       SIAM J. Numer. Anal. 15, 1978.
    """
    A = sp.csr_array(A)
    return _dissect(A.indptr.astype(np.int64), A.indices.astype(np.int32))


@numba.njit(cache=True, nogil=True)
def _dissect(indptr: Any, indices: Any) -> Any:
    n = len(indptr) - 1
    order = np.arange(n)
    region = np.zeros(n, dtype=np.int32)
    queue = np.zeros(n, dtype=np.int64)
    count = np.zeros(n, dtype=np.int32)
    f, g = np.zeros(n), np.zeros(n)
    # a stack of open regions [lo, hi) of `order`; each gets a label of its own
    stack = [(0, n)]
    label = 0
    while len(stack) > 0:
        lo, hi = stack.pop()
        label += 1
        for p in range(lo, hi):
            region[order[p]] = label
        if hi - lo <= LEAF:
            _minimum_degree(indptr, indices, order[lo:hi], region, count)
        elif _levels(indptr, indices, region, order[lo], queue, 0, f) < hi - lo:
            _push_components(indptr, indices, region, order, lo, hi, queue, f, stack)
        else:
            a, b = _cut(indptr, indices, region, order[lo:hi], queue, count, f, g)
            # a side is empty where everything touches everything: then any order will do
            if 0 < a < b:
                stack.append((lo, lo + a))
                stack.append((lo + a, lo + b))
    return order


@numba.njit(cache=True, nogil=True)
def _push_components(
    indptr: Any, indices: Any, region: Any, order: Any, lo: Any, hi: Any, queue: Any, f: Any, stack: Any
) -> None:
    label, tail = region[order[lo]], 0
    for p in range(lo, hi):
        if region[order[p]] == label:
            begin = tail
            tail = _levels(indptr, indices, region, order[p], queue, tail, f)
            for t in range(begin, tail):
                region[queue[t]] = 0
            stack.append((lo + begin, lo + tail))
    for p in range(lo, hi):
        order[p] = queue[p - lo]


@numba.njit(cache=True, nogil=True)
def _levels(indptr: Any, indices: Any, region: Any, start: Any, queue: Any, tail: Any, distance: Any) -> Any:
    """Breadth-first distances inside the region of `start`; appends its vertices to `queue`."""
    label = region[start]
    begin = head = tail
    # the sign marks what has been seen
    region[start] = -label
    distance[start] = 0.0
    queue[tail] = start
    tail += 1
    while head < tail:
        v = queue[head]
        head += 1
        for p in range(indptr[v], indptr[v + 1]):
            u = indices[p]
            if region[u] == label:
                region[u] = -label
                distance[u] = distance[v] + 1.0
                queue[tail] = u
                tail += 1
    for p in range(begin, tail):
        region[queue[p]] = label
    return tail


@numba.njit(cache=True, nogil=True)
def _cut(indptr: Any, indices: Any, region: Any, order: Any, queue: Any, count: Any, f: Any, g: Any) -> Any:
    """Reorder a connected region to first side, second side, separator; return where the last two begin."""
    _end_to_end(indptr, indices, region, order, queue, f, g)
    label = region[order[0]]
    size = len(order)
    values = np.zeros(size)
    for p in range(size):
        values[p] = f[order[p]]
    rank = np.argsort(values)
    for p in range(size):
        queue[p] = order[rank[p]]
    for p in range(size):
        order[p] = queue[p]
    split = _fewest(indptr, indices, region, order, count)
    for p in range(split):
        region[order[p]] = -label
    # the separator is what of the first side touches the second
    side = np.zeros(size, dtype=np.int8)
    for p in range(size):
        side[p] = 1 if p >= split else 0
    for p in range(split):
        if _touches(indptr, indices, region, order[p], label):
            side[p] = 2
    for p in range(split):
        if side[p] == 2:
            region[order[p]] = 0
    for p in range(split):
        if side[p] == 2 and not _touches(indptr, indices, region, order[p], -label):
            side[p] = 1
            region[order[p]] = label
    ends = np.zeros(3, dtype=np.int64)
    at = 0
    for kind in range(3):
        for p in range(size):
            if side[p] == kind:
                queue[at] = order[p]
                at += 1
        ends[kind] = at
    for p in range(size):
        order[p] = queue[p]
    return ends[0], ends[1]


@numba.njit(cache=True, nogil=True)
def _touches(indptr: Any, indices: Any, region: Any, v: Any, label: Any) -> Any:
    for e in range(indptr[v], indptr[v + 1]):
        if region[indices[e]] == label:
            return True
    return False


@numba.njit(cache=True, nogil=True)
def _end_to_end(indptr: Any, indices: Any, region: Any, order: Any, queue: Any, f: Any, g: Any) -> None:
    """Fill f, over a region, with a smooth function that falls from one end to the other."""
    size = len(order)
    label = region[order[0]]
    # the search that found the region connected left its furthest vertex last
    _levels(indptr, indices, region, queue[size - 1], queue, 0, g)
    _levels(indptr, indices, region, queue[size - 1], queue, 0, f)
    for p in range(size):
        f[order[p]] -= g[order[p]]
    for _ in range(SWEEPS):
        for p in range(size):
            v = order[p]
            total, k = f[v], 1
            for e in range(indptr[v], indptr[v + 1]):
                u = indices[e]
                if region[u] == label:
                    total += f[u]
                    k += 1
            f[v] += RELAXATION * (total / k - f[v])
        for p in range(size // 2):
            order[p], order[size - 1 - p] = order[size - 1 - p], order[p]


@numba.njit(cache=True, nogil=True)
def _fewest(indptr: Any, indices: Any, region: Any, order: Any, count: Any) -> Any:
    """Find after how many vertices of `order` the fewest of them touch the rest."""
    size = len(order)
    label = region[order[0]]
    for p in range(size):
        v = order[p]
        count[v] = 0
        for e in range(indptr[v], indptr[v + 1]):
            u = indices[e]
            if region[u] == label and u != v:
                count[v] += 1
    touching, best, split = 0, np.inf, size // 2
    for p in range(size):
        v = order[p]
        region[v] = -label
        if count[v] > 0:
            touching += 1
        for e in range(indptr[v], indptr[v + 1]):
            u = indices[e]
            if u == v or abs(region[u]) != label:
                continue
            count[u] -= 1
            if count[u] == 0 and region[u] == -label:
                touching -= 1
        share = (p + 1) / size
        if SMALLEST_SIDE <= share <= 1 - SMALLEST_SIDE:
            score = touching / (share * (1.0 - share))
            if score < best:
                best, split = score, p + 1
    for p in range(size):
        region[order[p]] = label
    return split


@numba.njit(cache=True, nogil=True)
def _minimum_degree(indptr: Any, indices: Any, order: Any, region: Any, local: Any) -> None:
    """Order a small region by minimum degree, the neighbours as bits of one word."""
    size = len(order)
    if size == 0:
        return
    label = region[order[0]]
    for p in range(size):
        local[order[p]] = p
    near = np.zeros(size, dtype=np.uint64)
    outside = np.zeros(size, dtype=np.int64)
    one = np.uint64(1)
    for p in range(size):
        for e in range(indptr[order[p]], indptr[order[p] + 1]):
            u = indices[e]
            if region[u] == label:
                if local[u] != p:
                    near[p] |= one << np.uint64(local[u])
            else:
                outside[p] += 1
    old = order.copy()
    open_ = np.ones(size, dtype=np.bool_)
    for step in range(size):
        best, at = 1 << 40, 0
        for p in range(size):
            if open_[p]:
                degree = _bits(near[p]) + outside[p]
                if degree < best:
                    best, at = degree, p
        open_[at] = False
        order[step] = old[at]
        for p in range(size):
            if open_[p] and (near[at] >> np.uint64(p)) & one:
                near[p] = (near[p] | near[at]) & ~(one << np.uint64(p)) & ~(one << np.uint64(at))
                outside[p] = max(outside[p], outside[at])


@numba.njit(cache=True, nogil=True, inline="always")
def _bits(x: Any) -> Any:
    x = x - ((x >> np.uint64(1)) & np.uint64(0x5555555555555555))
    x = (x & np.uint64(0x3333333333333333)) + ((x >> np.uint64(2)) & np.uint64(0x3333333333333333))
    x = (x + (x >> np.uint64(4))) & np.uint64(0x0F0F0F0F0F0F0F0F)
    return np.int64((x * np.uint64(0x0101010101010101)) >> np.uint64(56))
