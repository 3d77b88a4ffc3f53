"""The inner loop that finds a place for each frame among key frames."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

# summing in any order is what lets the loop over key frames run in vector lanes
_FAST = {"contract", "reassoc", "arcp", "nsz"}


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def place_each(D: Any, x: Any, y: Any, P: Any, tolerance: float, iterations: int) -> None:
    """Move every frame to where its distances to key frames are nearest to those of the poses.

    Parameters
    ----------
    D : (T, c) float
        Target distances to the key frames.
    x, y : (c,) float
        Places of the key frames.
    P : (T, 2) float
        Where to start; overwritten with the places found.
    tolerance : float
        Length of a step below which a frame has arrived.
    iterations : int
        Steps at most.
    """
    count = len(x)
    for i in range(len(P)):
        px, py = P[i, 0], P[i, 1]
        for _ in range(iterations):
            sx, sy = 0.0, 0.0
            for j in range(count):
                dx, dy = px - x[j], py - y[j]
                # 1e-150 only keeps 0 / 0 finite: dx and dy are 0 then
                ratio = D[i, j] / max(np.sqrt(dx * dx + dy * dy), 1e-150)
                sx += x[j] + ratio * dx
                sy += y[j] + ratio * dy
            sx /= count
            sy /= count
            step = np.hypot(sx - px, sy - py)
            px, py = sx, sy
            if step < tolerance:
                break
        P[i, 0], P[i, 1] = px, py
