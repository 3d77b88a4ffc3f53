"""When the sole of a foot stands still: a linear condition on the path by which the foot is displaced."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose.metrics.contacts import WINDOW
from tempose.metrics.skate import SOLE
from tempose.transfer.frames import release
from tempose.typing import BoolArray, FloatArray, IntArray

HORIZONTAL = [0, 2]
_BLOCK = 64
"""Frames of a foot held in memory at once."""


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


class FootFrames:
    """Vertices of one foot, read a few frames at a time: the frames may lie in a file.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames.
    vertices : (k,) int
        Vertices of the foot.
    """

    def __init__(self, V: FloatArray, vertices: IntArray) -> None:
        self._V, self._vertices = V, vertices
        self.shape = (len(V), len(vertices), 3)

    def __getitem__(self, frames: slice) -> FloatArray:
        """Read some frames.

        Parameters
        ----------
        frames : slice
            Which ones.

        Returns
        -------
        (K, k, 3) ndarray
            Positions.
        """
        found = self._V[frames][:, self._vertices]
        release(self._V)
        return found


def find_sole(
    foot: FloatArray | FootFrames, contact: BoolArray, height: float, fps: float, level: float = 0.0
) -> Sole:
    """Find what must be taken out of a foot so that its sole stands still.

    Parameters
    ----------
    foot : (T, k, 3) float or FootFrames
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
    T, k = foot.shape[:2]
    frames = np.flatnonzero(contact)
    windows = _window_rows(T, fps, frames)
    halo = int(np.ceil(_reach(fps))) + 1
    low, travel = np.zeros(T), np.zeros((len(frames), 2))
    for start in range(0, T, _BLOCK):
        stop = min(start + _BLOCK, T)
        first, last = max(start - halo, 0), min(stop + halo, T)
        part = np.asarray(foot[first:last], dtype=np.float64)
        y = part[start - first : stop - first, :, 1]
        low[start:stop] = y.min(axis=1)
        rows = slice(*np.searchsorted(frames, [start, stop]))
        share = y[frames[rows] - start]
        share = (share <= share.min(axis=1, keepdims=True) + SOLE * height).astype(np.float64)
        share /= share.sum(axis=1, keepdims=True)
        moved = windows[rows, first:last] @ part[..., HORIZONTAL].reshape(last - first, -1)
        travel[rows] = np.einsum("ck,cki->ci", share, moved.reshape(-1, k, 2))
    return Sole(np.asarray(contact, dtype=bool), windows, travel, low, level)


def _reach(fps: float) -> float:
    return max(WINDOW * fps / 2, 1.0)


def _window_rows(T: int, fps: float, frames: Any) -> Any:
    """Rows that take the place at the end of a frame's window minus that at its beginning."""
    if T < 2:
        return sp.csr_array((len(frames), T))
    reach = _reach(fps)
    ends = []
    for at in (np.minimum(frames + reach, T - 1), np.maximum(frames - reach, 0)):
        first = np.minimum(at.astype(int), T - 2)
        s, row = at - first, np.arange(len(frames))
        parts = (np.r_[1 - s, s], (np.r_[row, row], np.r_[first, first + 1]))
        ends.append(sp.csr_array(parts, shape=(len(frames), T)))
    return ends[0] - ends[1]
