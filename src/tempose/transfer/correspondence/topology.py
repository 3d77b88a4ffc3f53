"""Mirror symmetry of the connectivity alone, which a pose cannot spoil."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.geometry import vertex_adjacency, weld
from tempose.typing import FloatArray, IntArray

_SEEDS = 12
_WHOLE = 0.9
_HASHES = 8


def mirrored_faces(V: FloatArray, F: IntArray, V_other: FloatArray, guess: IntArray) -> IntArray:
    """Find opposite faces by walking over a mesh and its mirror image side by side.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    V_other : (n, 3) float
        Reflected vertices; they tell where to start.
    guess : (m,) int
        Face nearest to each reflected face.

    Returns
    -------
    (m,) ndarray of int
        Opposite faces; -1 for a connected piece that is not symmetric.

    Notes
    -----
    One pair of faces with one pair of corners fixes the map of a whole connected piece. Starts are pairs of
    faces whose neighbourhoods are alike and like no other's, and those that fit best in space; one that
    contradicts itself is given up.
    """
    _, inverse = weld(V)
    G = inverse[F].astype(np.int64)
    beside = _neighbours(G, int(inverse.max()) + 1)
    own, theirs = V[F], V_other[F]
    first = V[F[guess]]
    # the corner of the guessed face that is nearest to the reflected first corner
    turn = np.linalg.norm(first - theirs[:, :1], axis=2).argmin(axis=1)
    flipped = np.take_along_axis(first, ((turn[:, None] - np.arange(3)) % 3)[:, :, None], axis=1)
    misfit = np.linalg.norm(flipped - theirs, axis=2).max(axis=1)
    size = np.linalg.norm(own - own.mean(axis=1, keepdims=True), axis=2).max(axis=1)
    order = np.argsort(misfit / np.maximum(size, 1e-300), kind="stable")
    seeds = [(order, guess[order], turn[order]), _alike(G)]
    found = np.full(len(G), -1, dtype=np.int64)
    for start in seeds[::-1]:
        found = _pieces(G, beside, found, *start)
    return found


def _alike(G: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Pairs of faces with the same degrees round them, of which there are just two in the mesh.

    The colours of a vertex and its neighbours are hashed into its new colour, again and again [1]_; they know
    nothing of numbers, places and orientation.

    .. [1] Weisfeiler and Lehman, "The Reduction of a Graph to Canonical Form", 1968.
    """
    A = vertex_adjacency(G, int(G.max()) + 1).astype(np.uint64)
    colour = _mixed(np.asarray(A.sum(axis=1)).ravel().astype(np.uint64))
    for _ in range(_HASHES):
        colour = _mixed(colour * np.uint64(3) + A @ colour)
    corners = colour[G]
    _, kind, count = np.unique(corners.sum(axis=1), return_inverse=True, return_counts=True)
    kind = kind.ravel()
    order = np.argsort(kind, kind="stable")
    order = order[count[kind[order]] == 2]
    a, b = order[::2], order[1::2]
    turns = np.arange(3)
    mirrored = corners[b][:, (turns[:, None] - turns) % 3]
    fits = (mirrored == corners[a][:, None]).all(axis=2)
    # a corner that two turns put in place says nothing
    clear = fits.sum(axis=1) == 1
    return a[clear], b[clear], fits.argmax(axis=1)[clear]


def _mixed(x: IntArray) -> IntArray:
    x = (x ^ (x >> np.uint64(31))) * np.uint64(0x9E3779B97F4A7C15)
    return x ^ (x >> np.uint64(29))


def _pieces(
    G: IntArray, beside: IntArray, known: IntArray, faces: IntArray, partners: IntArray, turns: IntArray
) -> IntArray:
    n = int(G.max()) + 1
    result = np.array(known)
    piece = _label(beside)
    sizes = np.bincount(piece)
    tried = np.zeros(len(sizes), dtype=np.int64)
    for f, g, turn in zip(faces.tolist(), partners.tolist(), turns.tolist()):
        mine = int(piece[f])
        if result[f] >= 0 or tried[mine] >= _SEEDS:
            continue
        tried[mine] += 1
        found, count = _walk(G, beside, n, f, g, turn)
        if count >= _WHOLE * sizes[mine] and (result[found[found >= 0]] < 0).all():
            result = np.where(found >= 0, found, result)
            back = np.flatnonzero(found >= 0)
            result[found[back]] = back
    return result


def _neighbours(G: IntArray, n: int) -> IntArray:
    """(m, 3, 2): face and corner across the edge from corner k to k + 1; -1 at borders and forks."""
    m = len(G)
    a, b = G.ravel(), np.roll(G, -1, axis=1).ravel()
    keys = a * n + b
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    place = np.searchsorted(ordered, b * n + a)
    place = np.minimum(place, len(ordered) - 1)
    single = np.ones(len(ordered), dtype=np.bool_)
    same = ordered[1:] == ordered[:-1]
    single[1:] &= ~same
    single[:-1] &= ~same
    across = order[place]
    fits = (ordered[place] == b * n + a) & single[place] & (a != b)
    fits &= single[np.argsort(order, kind="stable")]
    return np.where(fits[:, None], np.stack([across // 3, across % 3], axis=1), -1).reshape(m, 3, 2)


@njit(cache=True)
def _label(beside: Any) -> Any:
    m = len(beside)
    label = np.full(m, -1, np.int64)
    stack = np.zeros(3 * m + 1, np.int64)
    count = 0
    for seed in range(m):
        if label[seed] >= 0:
            continue
        label[seed] = count
        stack[0] = seed
        top = 1
        while top > 0:
            top -= 1
            f = stack[top]
            for k in range(3):
                g = beside[f, k, 0]
                if g >= 0 and label[g] < 0:
                    label[g] = count
                    stack[top] = g
                    top += 1
        count += 1
    return label


@njit(cache=True)
def _walk(G: Any, beside: Any, n: int, seed: int, partner: int, turn: int) -> Any:
    """Corner c of a face lies opposite corner (s - c) mod 3 of its partner; s is kept a face."""
    m = len(G)
    image = np.full(m, -1, np.int64)
    shift = np.zeros(m, np.int64)
    of_vertex = np.full(n, -1, np.int64)
    stack = np.zeros(m, np.int64)
    image[seed], shift[seed] = partner, turn
    stack[0] = seed
    top, count = 1, 0
    while top > 0:
        top -= 1
        f = stack[top]
        g, s = image[f], shift[f]
        count += 1
        for c in range(3):
            here, there = G[f, c], G[g, (s - c) % 3]
            if of_vertex[here] >= 0 and of_vertex[here] != there:
                return image, 0
            of_vertex[here] = there
        for c in range(3):
            # the edge from corner c to c + 1 is seen from the other side from s - c - 1 to s - c
            f2, c2 = beside[f, c, 0], beside[f, c, 1]
            k = (s - c - 1) % 3
            g2, k2 = beside[g, k, 0], beside[g, k, 1]
            if (f2 < 0) != (g2 < 0):
                return image, 0
            if f2 < 0:
                continue
            # corner c2 of f2 is corner c + 1 of f, opposite corner k of g, which is corner k2 + 1 of g2
            s2 = (k2 + 1 + c2) % 3
            if image[f2] >= 0:
                if image[f2] != g2:
                    return image, 0
                continue
            image[f2], shift[f2] = g2, s2
            stack[top] = f2
            top += 1
    return image, count
