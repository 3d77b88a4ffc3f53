"""Where the partner of a picked place is likely to be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial import KDTree

from tempose.clips import Mesh
from tempose.geometry import face_normals, vertex_normals
from tempose.transfer.correspondence.rough import align_meshes
from tempose.transfer.correspondence.similarity import Alignment, align_points
from tempose.transfer.correspondence.warp import Warp
from tempose.transfer.correspondence.ways import Ways
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray, IntArray

_NORMAL = 0.03
"""Normals that are opposite count like twice so much of the diagonal."""
_GEODESIC = 0.3
_MARKS = 4
_POOL = 60
_APART = 0.01
_SURE = 0.06
_ENOUGH, _WRONG = 6, 2.5


@dataclass(frozen=True)
class Candidate:
    """A place that may be the partner of the picked one."""

    index: int
    """Face or vertex of the target."""
    score: float
    """1 for a place that fits in all respects, towards 0 for one that does not."""
    distance: float
    """From where the warp puts the pick, share of the target's diagonal."""
    normal_deg: float
    """Angle between the normals, degrees."""


class PartnerFinder:
    """Suggest partners: all that a pick does not change is made once.

    Parameters
    ----------
    source, target : Mesh
        Rest poses.
    pairs : Pairs, optional
        Pairs known so far, of faces or vertices; the warp passes through them.
    alignment : Alignment, optional
        Source to target; found by shape if not given, or by six or more pairs that contradict it.
    kind : {"faces", "vertices"}, default "faces"
        What is picked and suggested.

    Raises
    ------
    ValueError
        If the pairs are of joints or do not fit the meshes.
    """

    def __init__(
        self,
        source: Mesh,
        target: Mesh,
        pairs: Pairs | None = None,
        *,
        alignment: Alignment | None = None,
        kind: Literal["faces", "vertices"] = "faces",
    ) -> None:
        here, there = _known(source, target, pairs)
        if alignment is None:
            alignment = _overall(source, target, here, there)
        self.alignment, self.kind = alignment, kind
        self._partners: dict[int, int] = {}
        if pairs is not None and pairs.kind == kind:
            self._partners = dict(zip(np.asarray(pairs.source).tolist(), pairs.target.tolist()))
        V = alignment.apply(source.vertices)
        known = alignment.apply(here)
        self._warp = Warp(known, there, V, source.faces, target.vertices, target.faces)
        W = self._warp.apply(V)
        self._size = target.diagonal
        self._picks, self._pick_normals = _places(W, source.faces, kind)
        self._points, self._normals = _places(target.vertices, target.faces, kind)
        self._tree = KDTree(self._features(self._points, self._normals))
        self._ways = (Ways(V, source.faces), Ways(target.vertices, target.faces))
        self._marks = tuple(way.nearest(points) for way, points in zip(self._ways, (known, there)))
        self._corners = tuple(
            m.faces[:, 0] if kind == "faces" else np.arange(len(m.vertices)) for m in (source, target)
        )

    def _features(self, points: FloatArray, normals: FloatArray) -> FloatArray:
        return np.hstack([points, 0.5**0.5 * _NORMAL * self._size * normals])

    def suggest(self, picked: int, count: int = 5) -> tuple[Candidate, ...]:
        """Suggest partners of a picked place.

        Parameters
        ----------
        picked : int
            Face or vertex of the source.
        count : int, default 5
            How many at most.

        Returns
        -------
        tuple of Candidate
            Best first, the known partner of a paired place before all; none nearer to another than 1 % of
            the diagonal unless they face apart.

        Raises
        ------
        ValueError
            If the source has no such place.
        """
        if not 0 <= picked < len(self._picks):
            raise ValueError(f"picked must be one of {len(self._picks)} {self.kind}, got {picked}")
        at, normal = self._picks[picked], self._pick_normals[picked]
        known = self._partners.get(picked)
        pool = min(_POOL, len(self._points))
        _, near = self._tree.query(self._features(at[None], normal[None]), k=pool)
        near = np.atleast_1d(np.squeeze(near))
        near = near if known is None else np.union1d(near, [known])
        distance = np.linalg.norm(self._points[near] - at, axis=1) / self._size
        agree = self._normals[near] @ normal
        cost = distance**2 + _NORMAL**2 * (1 - agree) + self._detour(picked, near)
        cost[near == (-1 if known is None else known)] = 0.0
        chosen: list[Candidate] = []
        kept: list[int] = []
        for i in np.argsort(cost, kind="stable"):
            if len(chosen) == count:
                break
            if any(self._same(int(near[i]), int(near[j])) for j in kept):
                continue
            kept.append(int(i))
            angle = float(np.degrees(np.arccos(np.clip(agree[i], -1, 1))))
            score = float(np.exp(-cost[i] / _SURE**2))
            chosen.append(Candidate(int(near[i]), score, float(distance[i]), angle))
        return tuple(chosen)

    def _same(self, a: int, b: int) -> bool:
        near = np.linalg.norm(self._points[a] - self._points[b]) < _APART * self._size
        return bool(near and self._normals[a] @ self._normals[b] > 0)

    def _detour(self, picked: int, candidates: IntArray) -> FloatArray:
        """How much the ways to the nearest marks differ: far for the wrong side of a limb."""
        marks_here, marks_there = self._marks
        if len(marks_here) == 0:
            return np.zeros(len(candidates))
        here = self._ways[0].from_place(int(self._ways[0].place(self._corners[0][picked])))[marks_here]
        near = np.argsort(here, kind="stable")[:_MARKS]
        near = near[np.isfinite(here[near])]
        corners = self._ways[1].place(self._corners[1][candidates])
        there = np.array([self._ways[1].from_place(int(marks_there[j]))[corners] for j in near])
        there = there.reshape(len(near), len(candidates))
        weights = 1 / (here[near] / self._size + 0.02) ** 2
        off = np.where(np.isfinite(there), (there - here[near, None]) / self._size, 0.0)
        weights = weights / max(float(weights.sum()), 1e-300)
        return _GEODESIC * (weights[:, None] * np.minimum(off**2, 1.0)).sum(axis=0)


def suggest_partner(
    source: Mesh,
    target: Mesh,
    picked: int,
    pairs: Pairs | None = None,
    *,
    alignment: Alignment | None = None,
    kind: Literal["faces", "vertices"] = "faces",
    count: int = 5,
) -> tuple[Candidate, ...]:
    """Suggest partners of one picked place; see `PartnerFinder` for many.

    Parameters
    ----------
    source, target : Mesh
        Rest poses.
    picked : int
        Face or vertex of the source.
    pairs : Pairs, optional
        Pairs known so far.
    alignment : Alignment, optional
        Source to target.
    kind : {"faces", "vertices"}, default "faces"
        What is picked and suggested.
    count : int, default 5
        How many at most.

    Returns
    -------
    tuple of Candidate
        Best first.
    """
    return PartnerFinder(source, target, pairs, alignment=alignment, kind=kind).suggest(picked, count)


def pair_points(mesh: Mesh, indices: IntArray, kind: str) -> FloatArray:
    """Where picked faces or vertices lie.

    Parameters
    ----------
    mesh : Mesh
        At rest.
    indices : (k,) int
        Faces, or vertices for kind ``"vertices"``.
    kind : str
        Kind of the pairs.

    Returns
    -------
    (k, 3) ndarray
        Metres.
    """
    return mesh.vertices[indices] if kind == "vertices" else mesh.vertices[mesh.faces[indices]].mean(axis=1)


def _overall(source: Mesh, target: Mesh, here: FloatArray, there: FloatArray) -> Alignment:
    """Align by shape, unless the pairs say that this is the wrong way round.

    Pairs alone do worse where the poses differ: raised arms tilt and stretch the whole body.
    """
    by_shape = align_meshes(source, target)
    if len(here) < _ENOUGH:
        return by_shape
    by_pairs = align_points(here, there)
    off = np.sqrt(((by_shape.apply(here) - there) ** 2).sum(axis=1).mean()) / np.linalg.norm(
        np.ptp(there, axis=0)
    )
    return by_shape if off < _WRONG * by_pairs.residual else by_pairs


def _known(source: Mesh, target: Mesh, pairs: Pairs | None) -> tuple[FloatArray, FloatArray]:
    if pairs is None or len(pairs) == 0:
        return np.zeros((0, 3)), np.zeros((0, 3))
    if pairs.kind == "joints":
        raise ValueError(
            "pairs of kind 'joints' name no place on a source mesh; give pairs of faces on its template mesh"
        )
    sizes = [len(m.vertices) if pairs.kind == "vertices" else len(m.faces) for m in (source, target)]
    here, there = np.asarray(pairs.source), pairs.target
    for indices, size, name in ((here, sizes[0], "source"), (there, sizes[1], "target")):
        if indices.max() >= size:
            raise ValueError(f"pairs name {name} {pairs.kind} {indices.max()}, but it has {size}")
    return pair_points(source, here, pairs.kind), pair_points(target, there, pairs.kind)


def _places(V: FloatArray, F: IntArray, kind: str) -> tuple[FloatArray, FloatArray]:
    if kind == "vertices":
        return V, vertex_normals(V, F)
    return V[F].mean(axis=1), face_normals(V, F)
