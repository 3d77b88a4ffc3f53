"""A mesh in overlapping regions, and inner products of encoded poses region by region."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from tempose.geometry import vertex_components
from tempose.shape_spaces import GradientSpace, ShapeSpace, VertexSpace
from tempose.typing import FloatArray, IntArray

NEAREST = 4
"""Regions that share one element, by Gaussian weights."""

AT_ONCE = 20_000_000
"""Products of single elements that are held at once."""

ROUNDS = 10
"""Rounds that move the centres of regions to the middle of what is nearest to them."""


@dataclass(frozen=True, eq=False)
class Group:
    """Coordinates of a shape space that belong to like elements of the mesh: faces, vertices or pieces."""

    points: FloatArray
    """(E, 3) where the elements are, metres."""
    columns: IntArray
    """(E, c) the coordinates of each element."""


def groups_of(space: ShapeSpace, V: FloatArray, F: IntArray) -> list[Group]:
    """Return which coordinates belong where.

    Parameters
    ----------
    space : ShapeSpace
        A space whose coordinates are local: "vertex" or "gradient".
    V : (n, 3) float
        A pose.
    F : (m, 3) int
        Faces.

    Returns
    -------
    list of Group
        All coordinates, each once; empty for other spaces.
    """
    if isinstance(space, VertexSpace):
        return [Group(V, np.arange(3 * len(V)).reshape(-1, 3))]
    if not isinstance(space, GradientSpace):
        return []
    m = len(F)
    count, piece = vertex_components(F, len(V))
    sizes = np.bincount(piece, minlength=count)[:, None]
    centres = np.stack([np.bincount(piece, V[:, i], count) for i in range(3)], axis=1) / sizes
    faces = Group(V[F].mean(axis=1), np.arange(9 * m).reshape(9, m).T)
    return [faces, Group(centres, 9 * m + np.arange(3 * count).reshape(count, 3))]


def soft_regions(groups: Sequence[Group], count: int) -> list[Any]:
    """Cover a mesh with overlapping regions.

    Parameters
    ----------
    groups : sequence of Group
        The first gives the centres of the regions.
    count : int
        Number K of regions.

    Returns
    -------
    list of (E, K) csr_array
        For each group, how much each element belongs to each region; rows sum to 1.
    """
    points = groups[0].points
    centres = _spread(points, min(count, len(points)))
    for _ in range(ROUNDS):
        _, nearest = KDTree(centres).query(points)
        sizes = np.maximum(np.bincount(nearest, minlength=len(centres)), 1)[:, None]
        sums = np.stack([np.bincount(nearest, points[:, i], len(centres)) for i in range(3)], axis=1)
        centres = sums / sizes
    return [_shares(group.points, centres) for group in groups]


def _spread(points: FloatArray, count: int) -> FloatArray:
    gaps = np.square(points - points.mean(axis=0)).sum(axis=1)
    chosen: list[int] = []
    for _ in range(count):
        chosen.append(int(gaps.argmax()))
        new = np.square(points - points[chosen[-1]]).sum(axis=1)
        gaps = new if len(chosen) == 1 else np.minimum(gaps, new)
    return points[chosen]


def _shares(points: FloatArray, centres: FloatArray) -> Any:
    k = min(NEAREST, len(centres))
    gaps, nearest = KDTree(centres).query(points, k=k)
    gaps, nearest = gaps.reshape(len(points), k), nearest.reshape(len(points), k)
    width = np.square(gaps[:, min(1, k - 1)]).mean() or 1.0
    shares = np.exp(-(np.square(gaps) - np.square(gaps[:, :1])) / width)
    shares /= shares.sum(axis=1, keepdims=True)
    rows = np.repeat(np.arange(len(points)), k)
    return csr_array((shares.ravel(), (rows, nearest.ravel())), shape=(len(points), len(centres)))


@dataclass(frozen=True, eq=False)
class Regions:
    """A mesh in overlapping regions."""

    groups: tuple[Group, ...]
    """All coordinates of the shape space, by what they belong to."""
    shares: tuple[Any, ...]
    """(E, K) csr_array for each group: how much each element belongs to each region; rows sum to 1."""

    @property
    def count(self) -> int:
        """Number K of regions."""
        return int(self.shares[0].shape[1])

    def products(self, A: FloatArray, B: FloatArray) -> FloatArray:
        """Return inner products of encoded meshes in each region.

        Parameters
        ----------
        A : (T, d) float
            Encoded meshes.
        B : (N, d) float
            Encoded meshes.

        Returns
        -------
        (K, T, N) ndarray
            Summed over the regions they are ``A B^T``.
        """
        step = max(1, AT_ONCE // (len(self.groups[0].points) * len(B)))
        result: list[FloatArray] = []
        for i in range(0, len(A), step):
            part = A[i : i + step]
            inner = np.zeros((self.count, len(part) * len(B)))
            for group, share in zip(self.groups, self.shares):
                a = part[:, group.columns].transpose(1, 0, 2)
                b = B[:, group.columns].transpose(1, 2, 0)
                inner += share.T @ (a @ b).reshape(len(group.points), -1)
            result.append(inner.reshape(self.count, len(part), len(B)))
        return np.concatenate(result, axis=1)


def regions_of(space: ShapeSpace, V: FloatArray, F: IntArray, count: int) -> Regions | None:
    """Cover a mesh with overlapping regions.

    Parameters
    ----------
    space : ShapeSpace
        A space whose coordinates are local: "vertex" or "gradient".
    V : (n, 3) float
        A pose.
    F : (m, 3) int
        Faces.
    count : int
        Number of regions.

    Returns
    -------
    Regions or None
        None for other spaces.
    """
    groups = groups_of(space, V, F)
    return Regions(tuple(groups), tuple(soft_regions(groups, count))) if groups else None
