"""The compiled part of `tempose.geometry.collapses`."""

# pyright: reportMissingParameterType=false, reportArgumentType=false
from __future__ import annotations

from heapq import heapify, heappop, heappush

import numpy as np
from numba import njit

_FOLDED = 0.1
"""Cosine between a face's normals before and after, below which a collapse would fold it."""


@njit(cache=True)
def record_collapses(P, F, edges, Q, on_rim, count):
    """Collapse edges, cheapest first; P, F and Q are used up.

    Parameters
    ----------
    P : (n, 3) float
        Vertices.
    F : (m, 3) int64
        Faces.
    edges : (e, 2) int64
        Each once, the smaller vertex first: it is the one that stays.
    Q : (n, 4, 4) float
        Quadrics.
    on_rim : (n,) bool
        Vertices on open edges.
    count : int
        Vertices wanted.

    Returns
    -------
    pairs : (c, 2) int64
        Vertex that stayed, vertex that went.
    shares : (c,) float
        How far it moved.
    faces : (k, 3) int64
        What is left of F, over n vertices.
    alive : (n,) bool
        Vertices that are left.
    """
    n, m = len(P), len(F)
    first, last, after = _face_lists(F, n)
    live = np.ones(m, dtype=np.bool_)
    alive = np.zeros(n, dtype=np.bool_)
    alive[F.ravel()] = True
    stamp = np.zeros(n, dtype=np.int64)
    heap = [(0.0, np.int64(0), np.int64(0), np.int64(0), np.int64(0), 0.0)]
    heap.pop()
    for e in range(len(edges)):
        a, b = edges[e, 0], edges[e, 1]
        cost, share = _best(P, Q, a, b)
        heap.append((cost, a, b, stamp[a], stamp[b], share))
    heapify(heap)
    pairs = np.zeros((n, 2), dtype=np.int64)
    shares = np.zeros(n)
    left, done = alive.sum(), 0
    marks = np.full(n, -1, dtype=np.int64)
    turn = 0
    while left > count and len(heap) > 0:
        _, a, b, sa, sb, share = heappop(heap)
        if not (alive[a] and alive[b]) or stamp[a] != sa or stamp[b] != sb:
            continue
        turn += 2
        if not _may(P, F, first, after, live, on_rim, marks, turn, a, b, share):
            continue
        pairs[done, 0], pairs[done, 1], shares[done] = a, b, share
        done += 1
        left -= 1
        alive[b] = False
        for k in range(3):
            P[a, k] = (1.0 - share) * P[a, k] + share * P[b, k]
        Q[a] += Q[b]
        on_rim[a] = on_rim[a] or on_rim[b]
        _merge(F, first, last, after, live, a, b)
        stamp[a] += 1
        _push_round(P, F, Q, first, after, live, stamp, heap, marks, turn + 1, a)
    faces = np.zeros((live.sum(), 3), dtype=np.int64)
    k = 0
    for f in range(m):
        if live[f]:
            faces[k] = F[f]
            k += 1
    for v in range(n):
        alive[v] = alive[v] and first[v] >= 0
    return pairs[:done].copy(), shares[:done].copy(), faces, alive


@njit(cache=True)
def _face_lists(F, n):
    """Chains of corners, one for each vertex, that can be joined in no time."""
    first = np.full(n, -1, dtype=np.int64)
    last = np.full(n, -1, dtype=np.int64)
    after = np.full(3 * len(F), -1, dtype=np.int64)
    for corner in range(3 * len(F)):
        v = F[corner // 3, corner % 3]
        if first[v] < 0:
            first[v] = corner
        else:
            after[last[v]] = corner
        last[v] = corner
    return first, last, after


@njit(cache=True)
def _best(P, Q, a, b):
    """Least cost on the edge, and where: the quadric along it is a parabola."""
    S = Q[a] + Q[b]
    d = P[b] - P[a]
    c2 = c1 = 0.0
    for i in range(3):
        g = S[i, 3]
        for j in range(3):
            c2 += d[i] * S[i, j] * d[j]
            g += S[i, j] * P[a, j]
        c1 += d[i] * g
    share = 0.5
    if c2 > 1e-30:
        share = min(max(-c1 / c2, 0.0), 1.0)
    x = P[a] + share * d
    cost = S[3, 3]
    for i in range(3):
        cost += 2.0 * S[i, 3] * x[i]
        for j in range(3):
            cost += x[i] * S[i, j] * x[j]
    return max(cost, 0.0), share


@njit(cache=True)
def _may(P, F, first, after, live, on_rim, marks, turn, a, b, share):
    """Whether the collapse leaves a surface: no tear, no fold, no face on another."""
    corner, shared = first[a], 0
    while corner >= 0:
        f = corner // 3
        if live[f]:
            has = False
            for c in range(3):
                marks[F[f, c]] = turn
                has = has or F[f, c] == b
            shared += has
        corner = after[corner]
    if shared == 0 or shared > 2 or (on_rim[a] and on_rim[b] and shared == 2):
        return False
    # neighbours of both must be the far corners of the faces that go, and no others
    corner, common, faces_b = first[b], 0, 0
    while corner >= 0:
        f = corner // 3
        if live[f]:
            faces_b += 1
            for c in range(3):
                v = F[f, c]
                if v != a and v != b and marks[v] == turn:
                    common += 1
                    marks[v] = turn - 1
        corner = after[corner]
    if common != shared or faces_b <= shared:
        return False
    return not (
        _folds(P, F, first, after, live, a, b, share) or _folds(P, F, first, after, live, b, a, 1.0 - share)
    )


@njit(cache=True)
def _folds(P, F, first, after, live, a, b, share):
    x = (1.0 - share) * P[a] + share * P[b]
    corner = first[a]
    while corner >= 0:
        f, c = corner // 3, corner % 3
        if live[f]:
            u, v = F[f, (c + 1) % 3], F[f, (c + 2) % 3]
            if u != b and v != b:
                before = np.cross(P[u] - P[a], P[v] - P[a])
                now = np.cross(P[u] - x, P[v] - x)
                dot = before[0] * now[0] + before[1] * now[1] + before[2] * now[2]
                size = np.sqrt((before**2).sum() * (now**2).sum())
                if (before**2).sum() > 1e-24 and dot <= _FOLDED * size:
                    return True
        corner = after[corner]
    return False


@njit(cache=True)
def _merge(F, first, last, after, live, a, b):
    corner = first[b]
    while corner >= 0:
        f = corner // 3
        if live[f]:
            if F[f, 0] == a or F[f, 1] == a or F[f, 2] == a:
                live[f] = False
            else:
                F[f, corner % 3] = a
        corner = after[corner]
    if first[a] < 0:
        first[a] = first[b]
    else:
        after[last[a]] = first[b]
    last[a] = last[b]


@njit(cache=True)
def _push_round(P, F, Q, first, after, live, stamp, heap, marks, turn, a):
    corner = first[a]
    while corner >= 0:
        f = corner // 3
        if live[f]:
            for c in range(3):
                v = F[f, c]
                if v != a and marks[v] != turn:
                    marks[v] = turn
                    i, j = min(a, v), max(a, v)
                    cost, share = _best(P, Q, i, j)
                    heappush(heap, (cost, i, j, stamp[i], stamp[j], share))
        corner = after[corner]
