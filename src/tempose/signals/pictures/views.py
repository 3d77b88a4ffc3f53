"""From where a clip shows most of its motion."""

from __future__ import annotations

import numpy as np

from tempose.render.camera import axes_towards
from tempose.render.views import NAMED_VIEWS
from tempose.typing import FloatArray

TURN = np.radians(20.0)
"""How far a view is turned towards the front, so that legs do not hide one another."""


def telling_view(V: FloatArray) -> tuple[float, float]:
    """Choose between a look from the front and one from the side.

    Parameters
    ----------
    V : (T, n, 3) float
        Meshes, metres.

    Returns
    -------
    (float, float)
        Azimuth and elevation, radians, of the one in which the vertices move more: front or left side,
        turned a little towards the other.
    """
    moved = V - V.mean(axis=1, keepdims=True)
    moved = moved - moved.mean(axis=0)

    def seen(azimuth: float) -> float:
        return float(np.square(moved @ axes_towards(azimuth, 0.0)[:2].T).sum())

    front, side = NAMED_VIEWS["front"][0], NAMED_VIEWS["side"][0]
    turned = front + TURN if seen(front) > seen(side) else side - TURN
    return turned, float(np.radians(6.0))
