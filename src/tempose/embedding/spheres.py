"""Spheres packed along the medial surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy import ndimage

from tempose.embedding.cells import Cells
from tempose.typing import BoolArray, FloatArray, IntArray

_RIDGE = 0.8
_LEAST = 1.5


@dataclass(frozen=True)
class Spheres:
    """S spheres inside a body."""

    cells: IntArray
    """(S,) cell at each centre, largest sphere first."""
    centres: FloatArray
    """(S, 3) positions."""
    radii: FloatArray
    """(S,) distance of the centre to the surface."""


def medial_cells(cells: Cells) -> IntArray:
    """Cells near the medial surface.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.

    Returns
    -------
    (k,) ndarray of int
        Cells where the distance to the surface stops growing: its gradient is shorter than 0.8, or it is
        largest among the 26 neighbours.
    """
    depth = cells.solid.depth
    # central differences reach over the ridge and shrink there (Baran and Popovic 2007, section 3.1)
    steps = [np.gradient(depth, cells.solid.spacing, axis=axis) for axis in range(3)]
    slope = np.sqrt(sum(step**2 for step in steps))
    top = depth >= ndimage.maximum_filter(depth, size=3)
    # the ridges that run out into convex edges of the surface say nothing of the body
    ridge = ((slope < _RIDGE) & (depth > _LEAST * cells.solid.spacing)) | top
    return np.flatnonzero(ridge[tuple(cells.grid.T)])


def pack_spheres(cells: Cells) -> Spheres:
    """Cover the medial surface with spheres, the largest first, none centred in one before it.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.

    Returns
    -------
    Spheres
        Largest first.
    """
    medial = medial_cells(cells)
    radii = cells.depth[medial] + 0.5 * cells.solid.spacing
    order = np.argsort(-radii, kind="stable")
    points = cells.points[medial[order]]
    kept = order[_pack(points, radii[order])]
    return Spheres(medial[kept], cells.points[medial[kept]], radii[kept])


@njit(cache=True, nogil=True)
def _pack(points: FloatArray, radii: FloatArray) -> BoolArray:
    kept = np.zeros(len(points), dtype=np.bool_)
    list_ = np.zeros(len(points), dtype=np.int64)
    n = 0
    for i in range(len(points)):
        free = True
        for s in range(n):
            j = list_[s]
            x, y, z = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]
            if x * x + y * y + z * z < radii[j] * radii[j]:
                free = False
                break
        if free:
            kept[i] = True
            list_[n] = i
            n += 1
    return kept
