"""What is inside a mesh, on a grid of cells: holes, several pieces and folds allowed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage
from scipy.fft import dstn, idstn

from tempose.embedding._crossings import line_crossings
from tempose.embedding._distance import distance_inside
from tempose.typing import BoolArray, FloatArray, IntArray

CELLS = 160
"""Cells along the longest extent."""
_MOST_CELLS = 150_000
_MARGIN = 5
# an offset that no vertex of a modelled mesh hits, so that no line passes through an edge
_SHIFT = np.array([0.4142135, 0.3178372, 0.2360679])
_MAX_BRIDGE, _MAX_LOST = 6, 0.02


@dataclass(frozen=True)
class Solid:
    """The inside of a mesh as cells of one size."""

    inside: BoolArray
    """(X, Y, Z) bool."""
    origin: FloatArray
    """(3,) centre of cell (0, 0, 0)."""
    spacing: float
    """Edge of a cell."""
    depth: FloatArray
    """(X, Y, Z) distance to the surface; 0 outside."""
    walls: BoolArray
    """(3, X, Y, Z) bool, whether the surface runs between a cell and the next along each axis."""
    bridged: int = 0
    """How many cells wide the gaps were that had to be closed to make it one piece."""
    lost: float = 0.0
    """Share of the cells that were in other pieces and left out."""

    def points(self, cells: IntArray) -> FloatArray:
        """Centres of cells in space.

        Parameters
        ----------
        cells : (k, 3) int or float
            Grid coordinates.

        Returns
        -------
        (k, 3) ndarray
            Positions.
        """
        return self.origin + np.asarray(cells) * self.spacing

    def depth_at(self, points: FloatArray) -> FloatArray:
        """Distance to the surface at any points, 0 outside.

        Parameters
        ----------
        points : (..., 3) float
            Positions.

        Returns
        -------
        (...) ndarray
            Trilinear in the grid.
        """
        points = np.asarray(points, dtype=np.float64)
        where = (points.reshape(-1, 3) - self.origin).T / self.spacing
        depth = ndimage.map_coordinates(self.depth, where, order=1, mode="constant")
        return np.asarray(depth).reshape(points.shape[:-1])


def winding_numbers(V: FloatArray, F: IntArray, shape: tuple[int, ...]) -> tuple[FloatArray, BoolArray]:
    """How often a mesh winds round each cell of a grid.

    Parameters
    ----------
    V : (n, 3) float
        Vertices in units of cells.
    F : (m, 3) int
        Faces, counter-clockwise seen from outside.
    shape : (int, int, int)
        Size of the grid; the mesh lies well inside.

    Returns
    -------
    winding : (X, Y, Z) ndarray
        For a closed mesh the exact whole numbers. Round a hole they fade: the differences between
        neighbouring cells, counted along lines, are fitted in the sense of least squares.
    walls : (3, X, Y, Z) ndarray of bool
        Whether a face lies between a cell and the next along each axis.
    """
    divergence = np.zeros(shape, dtype=np.float32)
    walls = np.zeros((3, *shape), dtype=np.bool_)
    for axis in range(3):
        turn = [axis, *[a for a in range(3) if a != axis]]
        # an odd turn of the axes mirrors the mesh, which turns every sign round
        sign = -1 if axis == 1 else 1
        steps = np.zeros([shape[a] for a in turn], dtype=np.int32)
        wall = np.zeros(steps.shape, dtype=np.bool_)
        line_crossings(np.ascontiguousarray(V[:, turn]), F, steps, wall)
        walls[axis] = np.moveaxis(wall, 0, axis)
        change = sign * (np.diff(steps, axis=0, prepend=0)).astype(np.float32)
        divergence += np.moveaxis(change, 0, axis)
    return _solve_poisson(divergence), walls


def _solve_poisson(divergence: FloatArray) -> FloatArray:
    """Field of given second differences that vanishes outside the grid."""
    spectrum: Any = dstn(divergence, type=1, overwrite_x=True)
    laplace = np.zeros((1, 1, 1), dtype=np.float32)
    for axis, size in enumerate(divergence.shape):
        wave = 2 * np.cos(np.pi * np.arange(1, size + 1) / (size + 1)) - 2
        laplace = laplace + wave.astype(np.float32).reshape([-1 if a == axis else 1 for a in range(3)])
    field: Any = idstn(spectrum / laplace, type=1, overwrite_x=True)
    return field


def make_solid(V: FloatArray, F: IntArray, cells: int = CELLS) -> Solid:
    """Find the inside of a mesh.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    cells : int, default 160
        Cells along the longest extent; fewer where more than 150 000 would lie inside.

    Returns
    -------
    Solid
        One connected piece.

    Raises
    ------
    ValueError
        If the mesh has no extent or encloses nothing.
    """
    used = V[np.unique(F)] if len(F) else V[:0]
    extent = np.ptp(used, axis=0) if len(used) else np.zeros(3)
    if not len(used) or extent.max() <= 0:
        raise ValueError(f"a skeleton needs a mesh with extent, got {len(F)} faces of extent {extent}")
    spacing = float(extent.max()) / cells
    origin, inside, walls = _fill(V, F, used.min(axis=0), extent, spacing)
    count = int(inside.sum())
    if count > _MOST_CELLS:
        # a plump body fills the grid that a person leaves nearly empty
        spacing *= (count / _MOST_CELLS) ** (1 / 3)
        origin, inside, walls = _fill(V, F, used.min(axis=0), extent, spacing)
    if not inside.any():
        raise ValueError("the mesh encloses no volume; its surface may be open or folded flat")
    inside, bridged, lost = _one_piece(inside)
    depth = distance_inside(inside) * spacing - 0.5 * spacing * inside
    return Solid(inside, origin, spacing, np.maximum(depth, 0.0), walls, bridged, lost)


def _fill(
    V: FloatArray, F: IntArray, low: FloatArray, extent: FloatArray, spacing: float
) -> tuple[FloatArray, BoolArray, BoolArray]:
    origin = low - (_MARGIN + _SHIFT) * spacing
    shape = tuple(int(np.ceil(e / spacing)) + 2 * _MARGIN + 1 for e in extent)
    winding, walls = winding_numbers((V - origin) / spacing, np.asarray(F), shape)
    # a piece turned inside out winds -1 times
    return origin, np.abs(winding) > 0.5, walls


def _one_piece(inside: BoolArray) -> tuple[BoolArray, int, float]:
    """Close gaps between pieces, the narrowest first, until nearly all is one."""
    piece, lost = _largest(inside)
    if lost < _MAX_LOST:
        return piece, 0, lost
    outside = distance_inside(~inside)
    for width in range(1, _MAX_BRIDGE + 1):
        # the rim of the grid is outside: what has grown up to it shrinks back from it, too
        back = distance_inside(np.pad(outside <= width, 1))
        # what growing has joined, shrunk back; the cells that were there stay
        piece, lost = _largest(inside | (back[1:-1, 1:-1, 1:-1] > width))
        if lost < _MAX_LOST:
            return piece, width, lost
    return piece, _MAX_BRIDGE, lost


def _largest(solid: BoolArray) -> tuple[BoolArray, float]:
    labelled: Any = ndimage.label(solid)
    labels = labelled[0]
    sizes = np.bincount(labels.ravel())[1:]
    largest = int(sizes.argmax())
    return labels == largest + 1, 1.0 - float(sizes[largest]) / float(sizes.sum())
