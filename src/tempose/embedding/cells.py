"""The cells of a solid as a graph: neighbours, distances through the inside, what hangs together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.embedding._marching import march
from tempose.embedding.solid import Solid
from tempose.typing import BoolArray, FloatArray, IntArray

_SEED_CELLS = 3.0

_LEAST_KEPT = 0.85


def make_cells(solid: Solid, walls: BoolArray | None) -> Cells | None:
    """List the cells of a solid.

    Parameters
    ----------
    solid : Solid
        The inside of a mesh.
    walls : (3, X, Y, Z) bool or None
        What keeps a cell and the next along each axis apart. With those of the solid, limbs that touch or
        cut into each other stay apart, but so do the overlapping pieces of a doll.

    Returns
    -------
    Cells or None
        The largest piece; None when walls cut off more than 15 % of the solid.
    """
    grid = np.argwhere(solid.inside)
    if walls is None:
        return Cells(solid, grid, None)
    beside = _neighbours(_numbers(solid, grid), grid, walls)
    row, way = np.nonzero(beside >= 0)
    graph = sp.coo_array((np.ones(len(row), np.int8), (row, beside[row, way])), shape=(len(grid),) * 2)
    labels = connected_components(graph, directed=False)[1]
    kept = labels == np.bincount(labels).argmax()
    if kept.mean() < _LEAST_KEPT:
        return None
    return Cells(solid, grid[kept], walls)


def _numbers(solid: Solid, grid: IntArray) -> IntArray:
    number = np.full(solid.inside.shape, -1, dtype=np.int32)
    number[tuple(grid.T)] = np.arange(len(grid))
    return number


def _neighbours(number: IntArray, grid: IntArray, walls: BoolArray | None) -> IntArray:
    # the grid has an empty margin, so a step never leaves it
    columns: list[IntArray] = []
    for axis in range(3):
        step = np.eye(3, dtype=int)[axis]
        before, after = number[tuple((grid - step).T)], number[tuple((grid + step).T)]
        if walls is not None:
            before = np.where(walls[axis][tuple((grid - step).T)], -1, before)
            after = np.where(walls[axis][tuple(grid.T)], -1, after)
        columns += [before, after]
    return np.column_stack(columns)


@dataclass(frozen=True)
class Cells:
    """N inner cells of a solid in a list: one connected piece."""

    solid: Solid
    """Where they come from."""
    grid: IntArray
    """(N, 3) int, grid coordinates."""
    walls: BoolArray | None
    """(3, X, Y, Z) bool, what keeps a cell and the next along each axis apart, so that a hand on a thigh is
    not joined to it; None for nothing."""

    @cached_property
    def points(self) -> FloatArray:
        """(N, 3) positions of the centres."""
        return self.solid.points(self.grid)

    @cached_property
    def depth(self) -> FloatArray:
        """(N,) distance to the surface."""
        return self.solid.depth[tuple(self.grid.T)]

    @cached_property
    def number(self) -> IntArray:
        """(X, Y, Z) int32, place of a cell in the list; -1 outside."""
        return _numbers(self.solid, self.grid)

    @cached_property
    def neighbours(self) -> IntArray:
        """(N, 6) int32, neighbours along -x, +x, -y, +y, -z, +z; -1 where there is none."""
        return _neighbours(self.number, self.grid, self.walls)

    def distances(self, cell: int) -> FloatArray:
        """Distance from one cell through the inside.

        Parameters
        ----------
        cell : int
            Place in the list.

        Returns
        -------
        (N,) ndarray
            In the unit of the mesh.
        """
        away = np.linalg.norm(self.grid - self.grid[cell], axis=1)
        # near the seed the front is curved: start with the true distances of what is joined to it there
        near = np.flatnonzero(away <= _SEED_CELLS)
        near = near[self._joined(near, cell)]
        D = march(self.neighbours, near, away[near])
        return D * self.solid.spacing

    def _joined(self, near: IntArray, cell: int) -> BoolArray:
        inside = np.zeros(len(self.grid), dtype=np.bool_)
        inside[near] = True
        reached = np.zeros(len(self.grid), dtype=np.bool_)
        front = np.array([cell])
        while len(front):
            reached[front] = True
            beside = self.neighbours[front].ravel()
            beside = beside[beside >= 0]
            front = np.unique(beside[inside[beside] & ~reached[beside]])
        return reached[near]
