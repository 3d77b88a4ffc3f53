"""Where a body ends: the peaks of the distance from its middle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.peaks import merge_tree
from tempose.typing import FloatArray, IntArray

_PROMINENT = 0.12
_MOST = 9


@dataclass(frozen=True)
class Extremities:
    """The K ends of a body, the most prominent first."""

    cells: IntArray
    """(K,) cell at each end."""
    points: FloatArray
    """(K, 3) positions."""
    distances: FloatArray
    """(K, N) distance through the inside from each end to every cell."""
    prominence: FloatArray
    """(K,) how far each stands out, as a share of the farthest."""

    @property
    def between(self) -> FloatArray:
        """(K, K) distances between the ends."""
        return self.distances[:, self.cells]


def find_extremities(cells: Cells) -> Extremities:
    """Find the ends of a body: head, hands and feet of a human, tails too.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.

    Returns
    -------
    Extremities
        At most nine.
    """
    # from the cell whose farthest cell is nearest, about the belly, every limb leads away
    first = int(cells.distances(0).argmax())
    one = cells.distances(first)
    other = cells.distances(int(one.argmax()))
    middle = cells.distances(int(np.maximum(one, other).argmin()))
    tree = merge_tree(middle, cells.neighbours)
    prominence = tree.prominence / middle.max()
    count = min(int((prominence > _PROMINENT).sum()), _MOST)
    ends = tree.peaks[:count]
    distances = np.array([cells.distances(int(cell)) for cell in ends])
    return Extremities(ends, cells.points[ends], distances, prominence[:count])
