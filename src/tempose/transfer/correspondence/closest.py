"""Two surfaces as clouds of points, and the points of one that lie nearest to those of the other."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import KDTree

from tempose.geometry import edge_list, face_areas, vertex_areas, vertex_normals, weld
from tempose.typing import FloatArray, IntArray

_DENSE = 4000
_PROBES, _FEW_PROBES = 400, 120
_TRIM, _NEARLY_ALL = 0.8, 0.98


@dataclass(frozen=True)
class Cloud:
    """Points of a surface with their normals, and a few of them spread evenly."""

    points: FloatArray
    """(p, 3) metres."""
    normals: FloatArray
    """(p, 3) unit vectors."""
    probes: IntArray
    """(s,) int, indices of the few, far from each other, in order of choice."""
    centre: FloatArray
    """(3,) centroid of the area, metres."""
    axes: FloatArray
    """(3, 3) principal axes of the area, columns."""
    size: float
    """Root of the mean squared distance of the area to its centroid, metres."""
    diagonal: float
    """Of the bounding box, metres."""
    tree: KDTree = field(repr=False)
    """Of `points`."""


@dataclass(frozen=True)
class Match:
    """Points found to correspond under an alignment."""

    source: FloatArray
    """(k, 3) of the source, metres."""
    target: FloatArray
    """(k, 3) of the target, metres."""
    weights: FloatArray
    """(k,) 1, or 0 for what was trimmed away."""
    residual: float
    """Root mean squared distance of what was kept, share of the target's diagonal."""
    overall: float
    """The same of nearly all: heads, tails and feet, which tell front from back, are among the trimmed."""


def make_cloud(V: FloatArray, F: IntArray) -> Cloud:
    """Sample a surface: its vertices, and where those are few also the middles of edges, again and again.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces.

    Returns
    -------
    Cloud
        Turned, moved and scaled with the mesh; free of its numbering.
    """
    first, inverse = weld(V)
    V, F = V[first], inverse[F]
    while len(V) < _DENSE:
        V, F = _split(V, F)
    used = np.unique(F)
    areas = vertex_areas(V, F)
    centre, axes, size = _moments(V, F)
    P, N = V[used], vertex_normals(V, F)[used]
    probes = spread_points(P, _PROBES, centre)
    assert areas.sum() > 0 or size > 0
    return Cloud(P, N, probes, centre, axes, size, float(np.linalg.norm(np.ptp(P, axis=0))), KDTree(P))


def spread_points(P: FloatArray, count: int, centre: FloatArray) -> IntArray:
    """Choose points far from each other: always the one farthest from those chosen.

    Parameters
    ----------
    P : (p, 3) float
        Points.
    count : int
        How many; all if there are fewer.
    centre : (3,) float
        The first chosen lies farthest from here.

    Returns
    -------
    (s,) ndarray of int
        Indices, in order of choice.
    """
    count = min(count, len(P))
    chosen = np.zeros(count, dtype=np.int64)
    gap = np.full(len(P), np.inf)
    last = int(((P - centre) ** 2).sum(axis=1).argmax())
    for i in range(count):
        chosen[i] = last
        d = P - P[last]
        np.minimum(gap, np.einsum("ij,ij->i", d, d), out=gap)
        last = int(gap.argmax())
    return chosen


def match_clouds(
    here: Cloud, there: Cloud, scale: float, R: FloatArray, shift: FloatArray, coarse: bool = False
) -> Match:
    """Find closest points both ways under a similarity.

    Parameters
    ----------
    here, there : Cloud
        Source and target.
    scale : float
        Of the similarity from source to target.
    R : (3, 3) float
        Its rotation.
    shift : (3,) float
        Its translation, metres.
    coarse : bool, default False
        Whether a quarter of the probes will do.

    Returns
    -------
    Match
        The nearest 80 % count.
    """
    k = _FEW_PROBES if coarse else _PROBES
    i, j = here.probes[:k], there.probes[:k]
    moved = scale * here.points[i] @ R.T + shift
    gap, to = there.tree.query(moved)
    pulled = (there.points[j] - shift) @ R / scale
    back, origin = here.tree.query(pulled)
    source = np.concatenate([here.points[i], here.points[origin]])
    target = np.concatenate([there.points[to], there.points[j]])
    distance = np.concatenate([gap, scale * back])
    limit, most = np.quantile(distance, [_TRIM, _NEARLY_ALL])
    kept = distance <= limit
    residual, overall = (float(np.sqrt((distance[distance <= d] ** 2).mean())) for d in (limit, most))
    return Match(source, target, kept.astype(np.float64), residual / there.diagonal, overall / there.diagonal)


def _split(V: FloatArray, F: IntArray) -> tuple[FloatArray, IntArray]:
    edges = edge_list(F).astype(np.int64)
    middle = 0.5 * (V[edges[:, 0]] + V[edges[:, 1]])
    n = len(V)
    keys = edges[:, 0] * n + edges[:, 1]

    def between(a: IntArray, b: IntArray) -> IntArray:
        a, b = a.astype(np.int64), b.astype(np.int64)
        return n + np.searchsorted(keys, np.minimum(a, b) * n + np.maximum(a, b))

    sound = (F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])
    a, b, c = F[sound].T
    ab, bc, ca = between(a, b), between(b, c), between(c, a)
    faces = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([V, middle]), np.concatenate([np.stack(f, axis=1) for f in faces])


def _moments(V: FloatArray, F: IntArray) -> tuple[FloatArray, FloatArray, float]:
    areas = face_areas(V, F)
    corners = V[F]
    centroids = corners.mean(axis=1)
    centre = areas @ centroids / areas.sum()
    a = corners - centre
    # the integral over a triangle of x x^T: corners and centroid weighted 1 to 9
    second = np.einsum("m,mki,mkj->ij", areas, a, a) / 12
    c = centroids - centre
    second += 0.75 * np.einsum("m,mi,mj->ij", areas, c, c)
    second /= areas.sum()
    return centre, np.linalg.eigh(second)[1], float(np.sqrt(np.trace(second)))
