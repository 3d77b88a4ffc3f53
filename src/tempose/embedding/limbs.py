"""Trunk, arms and legs: regions of cells and the lines through their middles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from tempose.embedding.cells import Cells
from tempose.embedding.peaks import flood, join_cell
from tempose.embedding.search import Ends
from tempose.typing import BoolArray, FloatArray

_BIN = 1.5
_SMOOTH = 1.0


@dataclass(frozen=True)
class Limb:
    """A part of the body, cut by level sets of the distance from the head."""

    region: BoolArray
    """(N,) cells of the part."""
    start: float
    """Level at which it leaves the rest: crotch or armpit; 0 of the trunk."""
    end: float
    """Level at its far end."""
    levels: FloatArray
    """(k,) levels of the slices, ascending."""
    centres: FloatArray
    """(k, 3) centroid of each slice."""
    areas: FloatArray
    """(k,) area of each slice."""
    way: FloatArray
    """(N,) distance from the head, of every cell of the body."""

    def at(self, level: float | FloatArray) -> FloatArray:
        """Point of the middle line.

        Parameters
        ----------
        level : float or (q,) float
            Distance from the head.

        Returns
        -------
        (3,) or (q, 3) ndarray
            Positions; levels beyond the ends give the ends.
        """
        return np.stack([np.interp(level, self.levels, self.centres[:, a]) for a in range(3)], axis=-1)


@dataclass(frozen=True)
class Limbs:
    """The parts of a body; arms and legs in the order of `Ends`."""

    trunk: Limb
    """Head to crotch, without arms."""
    arms: tuple[Limb, Limb]
    """From the armpits."""
    legs: tuple[Limb, Limb]
    """From the crotch."""

    @property
    def pit(self) -> float:
        """Mean level of the armpits."""
        return (self.arms[0].start + self.arms[1].start) / 2


def cut_limbs(cells: Cells, ends: Ends) -> Limbs:
    """Cut a body into trunk, arms and legs.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    ends : Ends
        Its head, hands and feet.

    Returns
    -------
    Limbs
        The five parts. Going towards the head, the legs meet at the crotch and an arm meets the rest at the
        armpit.
    """
    D = ends.distances[0]
    beside = cells.neighbours
    _, a, b, f, g = (int(cell) for cell in ends.cells)
    crotch = D[join_cell(D, beside, f, g)]
    legs = [_limb(cells, D, float(crotch), foot) for foot in (f, g)]
    arms: list[Limb] = []
    for hand, other in ((a, b), (b, a)):
        pit = max(D[join_cell(D, beside, hand, end)] for end in (f, g, other))
        arms.append(_limb(cells, D, float(pit), hand))
    outside = arms[0].region | arms[1].region | legs[0].region | legs[1].region
    trunk = _slices(cells, D, ~outside, 0.0, float(crotch))
    return Limbs(trunk, (arms[0], arms[1]), (legs[0], legs[1]))


def _limb(cells: Cells, D: FloatArray, start: float, end: int) -> Limb:
    region = flood(D > start, cells.neighbours, end)
    return _slices(cells, D, region, start, float(D[region].max()))


def _slices(cells: Cells, D: FloatArray, region: BoolArray, start: float, end: float) -> Limb:
    width = _BIN * cells.solid.spacing
    slot = np.maximum(((D[region] - start) / width).astype(int), 0)
    slot = np.minimum(slot, max(int((end - start) / width), 0))
    count = np.bincount(slot)
    points = cells.points[region]
    sums = np.column_stack([np.bincount(slot, points[:, a]) for a in range(3)])
    levels = np.bincount(slot, D[region])
    used = count > 0
    centres = sums[used] / count[used, None]
    if len(centres) > 3:
        centres = gaussian_filter1d(centres, _SMOOTH, axis=0, mode="nearest")
    areas = count[used] * cells.solid.spacing**3 / width
    return Limb(region, start, end, levels[used] / count[used], centres, areas, D)
