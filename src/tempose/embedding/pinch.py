"""Walls where limbs only touch: narrow necks between the regions of packed spheres."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.embedding.cells import Cells
from tempose.embedding.spheres import Spheres
from tempose.typing import BoolArray, IntArray

_NEAREST = 12


def pinch_walls(cells: Cells, spheres: Spheres, owner: IntArray, narrow: float) -> BoolArray:
    """Wall off regions that meet in a neck narrower than both of them.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh, without walls.
    spheres : Spheres
        Spheres packed into it.
    owner : (N,) int
        Sphere to which each cell belongs.
    narrow : float
        Largest share of the smaller sphere's radius that counts as a neck.

    Returns
    -------
    (3, X, Y, Z) ndarray of bool
        Walls between a cell and the next along each axis.
    """
    S = len(spheres.radii)
    number, grid = cells.number, cells.grid
    steps = np.eye(3, dtype=int)
    faces: list[tuple[IntArray, IntArray]] = []
    neck = np.zeros(S * S)
    for step in steps:
        other = number[tuple((grid + step).T)]
        here = np.flatnonzero((other >= 0) & (owner != owner[np.maximum(other, 0)]))
        there = other[here]
        faces.append((here, there))
        depth = np.minimum(cells.depth[here], cells.depth[there])
        np.maximum.at(neck, owner[here] * S + owner[there], depth)
    neck = neck.reshape(S, S)
    neck = np.maximum(neck, neck.T)
    closed = neck < narrow * np.minimum(spheres.radii[:, None], spheres.radii)
    walls = np.zeros((3, *cells.solid.inside.shape), dtype=np.bool_)
    for axis, (here, there) in enumerate(faces):
        cut = here[closed[owner[here], owner[there]]]
        walls[axis][tuple(grid[cut].T)] = True
    return walls


def sphere_regions(cells: Cells, spheres: Spheres) -> IntArray:
    """Sphere to which each cell belongs.

    Parameters
    ----------
    cells : Cells
        N cells.
    spheres : Spheres
        Packed spheres.

    Returns
    -------
    (N,) ndarray of int
        Among the twelve spheres with the nearest centres, the one whose surface is nearest or around it.
    """
    k = min(_NEAREST, len(spheres.radii))
    away, index = KDTree(spheres.centres).query(cells.points, k=k)
    away, index = away.reshape(-1, k), index.reshape(-1, k)
    best = (away - spheres.radii[index]).argmin(axis=1)
    return index[np.arange(len(index)), best]
