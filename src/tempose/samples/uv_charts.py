"""Cut a character into charts as a tailor would: a front and a back piece of every limb."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.geometry import face_normals
from tempose.samples.parts import ELLIPSOID, LOFT, ROUND_CONE, Node, Part
from tempose.typing import FloatArray, IntArray

ISLAND = 12
"""Faces below which a piece is not worth a seam."""


@dataclass(frozen=True, eq=False)
class ChartRule:
    """How to cut the surface of some nodes."""

    front: tuple[float, float, float]
    """Direction that the front piece faces."""
    middle: bool = False
    """Cut in the plane x = 0 instead of along the axes of the solids."""
    hollow: bool = False
    """Also cut the inside from the outside."""


def chart_labels(
    V: FloatArray,
    F: IntArray,
    shares: FloatArray,
    nodes: Sequence[Node],
    parts: Sequence[Part],
    rules: Mapping[str, ChartRule],
) -> IntArray:
    """Say which piece of cloth each face belongs to.

    Parameters
    ----------
    V, F : (n, 3) float, (m, 3) int
        A closed mesh.
    shares : (n, N) float
        Whose surface each vertex is on.
    nodes, parts : sequence of Node, sequence of Part
        What the mesh was sculpted from.
    rules : mapping of str to ChartRule
        By name of a chart.

    Returns
    -------
    (m,) ndarray of int
        Equal for faces of one piece, which need not be connected.
    """
    owner = shares[F].sum(axis=1).argmax(axis=1)
    names = list(rules)
    chart = np.array([names.index(node.chart) for node in nodes])[owner]
    middle, normals = V[F].mean(axis=1), face_normals(V, F)
    side = np.zeros(len(F), dtype=np.int64)
    for k, node in enumerate(nodes):
        here, rule = np.flatnonzero(owner == k), rules[node.chart]
        a, b = _axis([part for part in parts if part.node == node.name])
        away = middle[here] if rule.middle else middle[here] - _nearest(middle[here], a, b)
        side[here] = away @ np.array(rule.front) > 0
        if rule.hollow:
            side[here] += 2 * ((normals[here] * away).sum(axis=1) < 0)
    neighbours = face_neighbours(F)
    return _without_islands(_smoothed(4 * chart + side, neighbours), neighbours)


def _axis(parts: Sequence[Part]) -> tuple[FloatArray, FloatArray]:
    """List the ends of segments along the main solid, or along all cones where a cone comes first."""
    first = parts[0]
    if first.kind == LOFT:
        assert first.table is not None
        axes = first.data[3:12].reshape(3, 3)
        t = np.linspace(0.0, first.data[12], len(first.table))[::8]
        points = first.data[:3] + first.table[::8, :2] @ axes[:2] + t[:, None] * axes[2]
        return points[:-1], points[1:]
    if first.kind == ELLIPSOID:
        return first.data[None, :3], first.data[None, :3]
    cones = np.array([part.data for part in parts if part.kind == ROUND_CONE])
    return cones[:, :3], cones[:, 3:6]


def _nearest(P: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Nearest points on segments."""
    best, distance = np.zeros(P.shape), np.full(len(P), np.inf)
    for start, end in zip(a, b):
        along = end - start
        t = np.clip((P - start) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
        q = start + t[:, None] * along
        d = np.linalg.norm(P - q, axis=1)
        best[d < distance], distance = q[d < distance], np.minimum(d, distance)
    return best


def face_neighbours(F: IntArray) -> IntArray:
    """Find the face across each edge of a closed mesh.

    Parameters
    ----------
    F : (m, 3) int
        Faces; edge i runs from corner i to the next one.

    Returns
    -------
    (m, 3) ndarray of int
        Faces.
    """
    a, b = F.ravel().astype(np.int64), np.roll(F, -1, axis=1).ravel()
    order = np.lexsort((np.maximum(a, b), np.minimum(a, b)))
    across = np.zeros(len(a), dtype=np.int64)
    across[order[::2]], across[order[1::2]] = order[1::2] // 3, order[::2] // 3
    return across.reshape(-1, 3)


def _smoothed(labels: IntArray, neighbours: IntArray) -> IntArray:
    """Let faces join the chart of two of their neighbours, until none wants to."""
    labels = labels.copy()
    for turn in range(30):
        around = labels[neighbours]
        pair = np.where(around[:, 1] == around[:, 2], around[:, 1], around[:, 0])
        agree = (around == pair[:, None]).sum(axis=1) >= 2
        wants = agree & (pair != labels)
        # half of them at a time, or neighbours swap for ever
        wants &= ~wants[neighbours].any(axis=1) | (np.arange(len(labels)) % 2 == turn % 2)
        if not wants.any():
            break
        labels[wants] = pair[wants]
    return labels


def _without_islands(labels: IntArray, neighbours: IntArray) -> IntArray:
    """Give pieces of few faces to the piece that surrounds them most."""
    labels = labels.copy()
    for piece in sorted(connected_pieces(labels, neighbours), key=len):
        around = labels[neighbours[piece]]
        around = around[around != labels[piece[0]]]
        if len(piece) < max(ISLAND, 0.002 * len(labels)) and len(around):
            names, counts = np.unique(around, return_counts=True)
            labels[piece] = names[counts.argmax()]
    return labels


def connected_pieces(labels: IntArray, neighbours: IntArray) -> list[IntArray]:
    """Divide faces into connected pieces of one label.

    Parameters
    ----------
    labels : (m,) int
        Label of each face; faces with a negative one are left out.
    neighbours : (m, 3) int
        Faces across the edges.

    Returns
    -------
    list of (k,) ndarray of int
        Faces of each piece.
    """
    m = len(labels)
    f, g = np.repeat(np.arange(m), 3), neighbours.ravel()
    same = (labels[f] == labels[g]) & (labels[f] >= 0)
    graph = sp.coo_array((np.ones(int(same.sum())), (f[same], g[same])), shape=(m, m))
    _, component = connected_components(graph, directed=False)
    kept = np.flatnonzero(labels >= 0)
    order = kept[np.argsort(component[kept], kind="stable")]
    return np.split(order, np.flatnonzero(np.diff(component[order])) + 1)


def cut_open(F: IntArray) -> IntArray:
    """Give every fan of faces around a vertex a vertex of its own, so that no chart is pinched.

    Parameters
    ----------
    F : (m, 3) int
        Faces of one chart.

    Returns
    -------
    (m, 3) ndarray of int
        Faces over new vertices, all in use.
    """
    a, b = F.ravel().astype(np.int64), np.roll(F, -1, axis=1).ravel().astype(np.int64)
    n = int(F.max()) + 1
    h = np.arange(len(a))
    following = h - h % 3 + (h + 1) % 3
    order = np.argsort(a * n + b)
    at = np.searchsorted((a * n + b)[order], b * n + a)
    twin = order[np.minimum(at, len(order) - 1)]
    inner = (a[twin] == b) & (b[twin] == a)
    rows = np.concatenate([h[inner], following[inner]])
    cols = np.concatenate([following[twin[inner]], twin[inner]])
    graph = sp.coo_array((np.ones(len(rows)), (rows, cols)), shape=(len(a), len(a)))
    return connected_components(graph, directed=False)[1].reshape(-1, 3).astype(np.int64)


def is_disc(F: IntArray) -> bool:
    """Whether connected faces without pinches form a disc.

    Parameters
    ----------
    F : (m, 3) int
        Faces over vertices that are all in use.

    Returns
    -------
    bool
        True if the Euler characteristic is 1.
    """
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    return int(F.max()) + 1 - len(np.unique(edges, axis=0)) + len(F) == 1
