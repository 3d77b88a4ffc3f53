"""Where a plane cuts a mesh, as exact polylines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.geometry import weld
from tempose.typing import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Loop:
    """One connected piece of a plane section: s segments, each across one face."""

    points: FloatArray
    """(s + 1, 3) metres, in order; the first is repeated at the end of a closed loop."""
    faces: IntArray
    """(s,) int, the face that each segment crosses."""
    closed: bool
    """Whether it comes back to its start; it does not where the mesh has a hole."""

    @property
    def length(self) -> float:
        """Metres."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


class Sections:
    """Cut one mesh by many planes; vertices at equal positions count as one, so that seams do not cut loops.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces.
    """

    def __init__(self, V: FloatArray, F: IntArray) -> None:
        first, inverse = weld(V)
        self.V, self.F = V[first], inverse[F]

    def cut(self, point: FloatArray, normal: FloatArray, through: int | None = None) -> list[Loop]:
        """Cut by a plane.

        Parameters
        ----------
        point : (3,) float
            On the plane.
        normal : (3,) float
            Its normal, any length.
        through : int, optional
            Return only the loop that crosses this face.

        Returns
        -------
        list of Loop
            All loops, or the one through a face, or none. A vertex in the plane counts as above it, so
            that every face is crossed by one segment or by none.
        """
        height = (self.V - point) @ (np.asarray(normal) / np.linalg.norm(normal))
        above: BoolArray = np.asarray(height >= 0)
        corners = above[self.F]
        cut = np.flatnonzero(corners.any(axis=1) & ~corners.all(axis=1))
        if len(cut) == 0 or (through is not None and not _contains(cut, through)):
            return []
        edges, places = self._crossings(cut, corners[cut], height)
        nodes, ends = np.unique(edges.reshape(-1), return_inverse=True)
        points = np.zeros((len(nodes), 3))
        points[ends.ravel()] = places.reshape(-1, 3)
        start = None if through is None else int(np.searchsorted(cut, through))
        return [
            Loop(points[chain], cut[segments], bool(chain[0] == chain[-1]) and len(segments) > 2)
            for chain, segments in _chains(ends.reshape(-1, 2), start)
        ]

    def _crossings(self, cut: IntArray, above: BoolArray, height: FloatArray) -> tuple[IntArray, FloatArray]:
        """Edge numbers (c, 2) and points (c, 2, 3) at which the cut faces are entered and left."""
        lone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), above.argmin(axis=1))
        row = np.arange(len(cut))
        F = self.F[cut]
        a = F[row, lone][:, None]
        b = np.stack([F[row, (lone + 1) % 3], F[row, (lone + 2) % 3]], axis=1)
        low, high = np.minimum(a, b), np.maximum(a, b)
        # always from the lower vertex: both faces of an edge must find the very same point
        share = height[low] / (height[low] - height[high])
        points = self.V[low] + share[..., None] * (self.V[high] - self.V[low])
        return low.astype(np.int64) * len(self.V) + high, points


def loop_centre(loop: Loop, axis: FloatArray) -> FloatArray:
    """Centroid of the area inside a loop.

    Parameters
    ----------
    loop : Loop
        Section of a part.
    axis : (3,) float
        Unit normal of its plane.

    Returns
    -------
    (3,) ndarray
        Metres; that of the outline where the area vanishes.
    """
    P = loop.points[:-1] if loop.closed else loop.points
    origin = P.mean(axis=0)
    a = P - origin
    b = np.roll(a, -1, axis=0)
    area = np.cross(a, b) @ axis
    if abs(area.sum()) <= 1e-9 * loop.length**2:
        return origin
    return origin + (area[:, None] * (a + b)).sum(axis=0) / (3 * area.sum())


def _contains(ordered: IntArray, value: int) -> bool:
    i = int(np.searchsorted(ordered, value))
    return i < len(ordered) and int(ordered[i]) == value


def _chains(segments: IntArray, start: int | None) -> list[tuple[IntArray, IntArray]]:
    """Join segments (c, 2) of node numbers to chains of nodes and segments."""
    order = np.argsort(segments.ravel(), kind="stable")
    first = np.searchsorted(segments.ravel()[order], np.arange(int(segments.max()) + 2))
    at = order // 2
    used = np.zeros(len(segments), dtype=np.bool_)

    def walk(node: int, stop: int) -> tuple[list[int], list[int]]:
        nodes, path = [node], list[int]()
        while True:
            following = next((int(s) for s in at[first[node] : first[node + 1]] if not used[s]), None)
            if following is None:
                return nodes, path
            used[following] = True
            a, b = segments[following]
            node = int(b if a == node else a)
            nodes.append(node)
            path.append(following)
            if node in (nodes[0], stop):
                return nodes, path

    found: list[tuple[IntArray, IntArray]] = []
    for s in range(len(segments)) if start is None else [start]:
        if used[s]:
            continue
        used[s] = True
        a, b = (int(x) for x in segments[s])
        nodes, path = walk(b, a)
        if nodes[-1] != a:
            back_nodes, back_path = walk(a, -1)
            nodes, path = back_nodes[::-1] + nodes, [*back_path[::-1], s, *path]
        else:
            nodes, path = [a, *nodes], [s, *path]
        found.append((np.array(nodes), np.array(path)))
    return found
