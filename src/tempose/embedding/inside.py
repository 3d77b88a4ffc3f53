"""Joints that came to lie outside the body, moved back into it."""

from __future__ import annotations

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.human import NAMES
from tempose.typing import FloatArray

_DEEP, _THIN = 0.012, {"hand": 0.006, "foot": 0.006, "toes": 0.004}
"""How deep below the surface a joint lies at least, as shares of the way from the head to the feet."""


def pull_inside(cells: Cells, joints: FloatArray, size: float) -> FloatArray:
    """Move joints that lie outside the body, or barely inside, to the nearest place that is deep enough.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    joints : (18, 3) float
        Positions in the order of `tempose.embedding.human.NAMES`.
    size : float
        Way from the head to the feet.

    Returns
    -------
    (18, 3) ndarray
        The same but for those that lay too high; one whose place is nowhere that deep goes to where its
        neighbourhood is deepest.
    """
    moved = np.array(joints)
    least = size * np.array([_THIN.get(name.split("_")[-1], _DEEP) for name in NAMES])
    for j in np.flatnonzero(cells.solid.depth_at(joints) < least):
        away = np.linalg.norm(cells.points - joints[j], axis=1)
        # in a body too slender for that, what is deep by its own measure will do
        deep = cells.depth >= min(
            float(least[j]), float(cells.depth[away <= away.min() + 4 * least[j]].max())
        )
        moved[j] = cells.points[deep][away[deep].argmin()]
    return moved
