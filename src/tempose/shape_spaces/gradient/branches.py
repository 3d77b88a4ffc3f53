"""Rotation vectors that go on from the frame before, past half a turn too."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.typing import FloatArray

TURN = 2.0 * math.pi
NO_TURN = 1e-12
"""Angle below which a rotation vector has no direction any more."""


@numba.njit(cache=True, nogil=True, error_model="numpy")
def follow_branch(before: Any, weigh: Any, w: Any) -> None:
    """Replace rotation vectors by the ones of the same rotations that lie nearest to others.

    Parameters
    ----------
    before : (3, m) ndarray
        Weighted rotation vectors of the frame before.
    weigh : (m,) ndarray
        Inverse of the weights.
    w : (3, m) ndarray
        Weighted rotation vectors; changed by whole turns about their axes.
    """
    for f in range(w.shape[1]):
        k = weigh[f]
        x, y, z = k * w[0, f], k * w[1, f], k * w[2, f]
        px, py, pz = k * before[0, f], k * before[1, f], k * before[2, f]
        angle = math.sqrt(x * x + y * y + z * z)
        if angle > NO_TURN:
            along = (x * px + y * py + z * pz) / angle
            turns = math.floor((along - angle) / TURN + 0.5)
            if turns != 0.0:
                factor = 1.0 + TURN * turns / angle
                w[0, f], w[1, f], w[2, f] = factor * w[0, f], factor * w[1, f], factor * w[2, f]
        else:
            # any axis will do: the one of the frame before
            length = math.sqrt(px * px + py * py + pz * pz)
            turns = math.floor(length / TURN + 0.5)
            if turns != 0.0:
                factor = TURN * turns / length
                w[0, f], w[1, f], w[2, f] = (
                    factor * before[0, f],
                    factor * before[1, f],
                    factor * before[2, f],
                )


def follow_path(w: FloatArray, weigh: FloatArray, after: FloatArray | None = None) -> None:
    """Make the rotation vectors of a clip go on from frame to frame.

    Parameters
    ----------
    w : (T, 3, m) ndarray
        Weighted rotation vectors, each of at most half a turn; changed in place.
    weigh : (m,) float
        Inverse of the weights.
    after : (3, m) float, optional
        Rotation vectors of the frame before the first; if not given, the smallest frame stays as it is and
        the others go on from it in both directions.
    """
    if len(w) == 0:
        return
    if after is not None:
        follow_branch(after, weigh, w[0])
    start = 0 if after is not None else int(np.argmin(np.einsum("tcm,tcm->t", w, w)))
    for t in range(start + 1, len(w)):
        follow_branch(w[t - 1], weigh, w[t])
    for t in range(start - 1, -1, -1):
        follow_branch(w[t + 1], weigh, w[t])
