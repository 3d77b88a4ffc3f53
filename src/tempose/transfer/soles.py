"""When the sole of a foot stands still: a linear condition on the path by which the foot is displaced."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose.metrics.contacts import WINDOW
from tempose.metrics.skate import SOLE
from tempose.typing import BoolArray, FloatArray

HORIZONTAL = [0, 2]


@dataclass(frozen=True)
class Sole:
    """What the feet ask of the root and of themselves: small arrays, whatever the size of the mesh."""

    contact: BoolArray
    """(T,) whether the foot shall stand."""
    windows: Any
    """(c, T) sparse: a path to its travel over the window round each frame in contact."""
    travel: FloatArray
    """(c, 2) metres: horizontal travel of the lowest vertices over the same windows."""
    low: FloatArray
    """(T,) metres: height of the lowest vertex."""
    level: float = 0.0
    """Metres by which what it stands on is higher than the ground."""

    def slip(self, shift: FloatArray) -> FloatArray:
        """Travel of the sole when the foot is also shifted.

        Parameters
        ----------
        shift : (T, 3) float
            Metres.

        Returns
        -------
        (c, 2) ndarray
            Metres over the window round each frame in contact.
        """
        return self.travel + self.windows @ shift[:, HORIZONTAL]


def find_sole(foot: FloatArray, contact: BoolArray, height: float, fps: float, level: float = 0.0) -> Sole:
    """Find what must be taken out of a foot so that its sole stands still.

    Parameters
    ----------
    foot : (T, k, 3) float
        Vertices of the foot, metres.
    contact : (T,) bool
        Frames in which it shall stand.
    height : float
        Height of the target, metres.
    fps : float
        Frames per second.
    level : float, default 0
        Metres by which what it stands on is higher than the ground.

    Returns
    -------
    Sole
        Conditions and heights.

    Notes
    -----
    What stands is what `tempose.metrics.sole_velocities` measures: the mean of the vertices that are lowest
    in that frame, over the same window. So a foot may roll from heel to toes; what is low is held while low.
    """
    frames = np.flatnonzero(contact)
    T, k = foot.shape[:2]
    windows = _window_rows(T, fps, frames)
    y = np.asarray(foot[..., 1], dtype=np.float64)
    low = y.min(axis=1)
    share = (y[frames] <= low[frames, None] + SOLE * height).astype(np.float64)
    share /= share.sum(axis=1, keepdims=True)
    flat = np.asarray(foot[..., HORIZONTAL], dtype=np.float64).reshape(T, -1)
    travel = np.einsum("ck,cki->ci", share, (windows @ flat).reshape(len(frames), k, 2))
    return Sole(np.asarray(contact, dtype=bool), windows, travel, low, level)


def _window_rows(T: int, fps: float, frames: Any) -> Any:
    """Rows that take the place at the end of a frame's window minus that at its beginning."""
    if T < 2:
        return sp.csr_array((len(frames), T))
    reach = max(WINDOW * fps / 2, 1.0)
    ends = []
    for at in (np.minimum(frames + reach, T - 1), np.maximum(frames - reach, 0)):
        first = np.minimum(at.astype(int), T - 2)
        s, row = at - first, np.arange(len(frames))
        parts = (np.r_[1 - s, s], (np.r_[row, row], np.r_[first, first + 1]))
        ends.append(sp.csr_array(parts, shape=(len(frames), T)))
    return ends[0] - ends[1]
