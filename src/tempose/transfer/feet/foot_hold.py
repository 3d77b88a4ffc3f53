"""Paths by which the feet are displaced so that soles stand still and on the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.transfer.feet.soles import HORIZONTAL, Sole
from tempose.transfer.feet.steady_path import path_above, steady_path
from tempose.typing import FloatArray

FADE = 0.1
"""Seconds: time constant with which a displacement fades before and after contact."""


def hold_feet(soles: Sequence[Sole], shift: FloatArray, ground: float, fps: float) -> FloatArray:
    """Find the displacement of each foot that is left to it once the root is placed.

    Parameters
    ----------
    soles : sequence of Sole
        One a foot.
    shift : (T, 3) float
        Translation of the whole body, metres.
    ground : float
        Height of the ground, metres.
    fps : float
        Frames per second.

    Returns
    -------
    (T, f, 3) ndarray
        Metres. In contact the lowest vertices do not move horizontally and touch the ground; nowhere does a
        foot sink into it; in between, the path of least acceleration.
    """
    paths = np.zeros((len(shift), len(soles), 3))
    for f, sole in enumerate(soles):
        paths[:, f, HORIZONTAL] = steady_path(sole.windows, -sole.slip(shift), FADE * fps)
        floor = ground + np.where(sole.contact, sole.level, 0.0)
        paths[:, f, 1] = path_above(floor - sole.low - shift[:, 1], sole.contact, FADE * fps)
    return paths
