"""Windows that cover a clip, each with a weight that fades over what it shares with its neighbours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Cover:
    """Windows one after another; neighbours share some frames, no three windows share any."""

    starts: FloatArray
    """(W,) ticks where the windows begin."""
    stops: FloatArray
    """(W,) ticks where they end; between ``starts[i + 1]`` and ``stops[i]`` window i fades into the next."""

    def __post_init__(self) -> None:
        starts = as_floats(self.starts, "starts", ("W",))
        stops = as_floats(self.stops, "stops", (len(starts),))
        if len(starts) < 1 or (starts[1:] >= stops[:-1]).any() or (starts[2:] < stops[:-2]).any():
            raise ValueError("windows must share ticks with their neighbours, and with no other window")
        for name, array in (("starts", starts), ("stops", stops)):
            object.__setattr__(self, name, read_only(array))

    def __len__(self) -> int:
        return len(self.starts)

    def __call__(self, ticks: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the windows at ticks and how much the later one counts.

        Parameters
        ----------
        ticks : (...) float
            Times in frames of the captured clip.

        Returns
        -------
        first : (...) ndarray of int
            Window i; where the weight is not 0, window i + 1 counts too.
        weight : (...) ndarray
            Of window i + 1, 0 to 1, twice continuously differentiable; that of window i is the rest.
        """
        ticks = np.asarray(ticks, dtype=np.float64)
        if len(self) == 1:
            return np.zeros(ticks.shape, dtype=np.int64), np.zeros(ticks.shape)
        first = np.minimum(np.searchsorted(self.stops[:-1], ticks, side="right"), len(self) - 2)
        begin, end = self.starts[1:][first], self.stops[:-1][first]
        s = np.clip((ticks - begin) / (end - begin), 0.0, 1.0)
        return first, s**3 * (10 + s * (6 * s - 15))

    def frames(self, i: int) -> slice:
        """Return the frames of a window, those that it shares included.

        Parameters
        ----------
        i : int
            Which window.

        Returns
        -------
        slice
            Whole frames.
        """
        return slice(int(np.ceil(self.starts[i])), int(np.floor(self.stops[i])) + 1)


def cover(n_frames: int, window: int, overlap: int) -> Cover:
    """Cover a clip with windows of about the same length.

    Parameters
    ----------
    n_frames : int
        Number T of frames.
    window : int
        Largest number of frames in a window.
    overlap : int
        Frames that neighbours share at least, 2 or more and at most a third of a window.

    Returns
    -------
    Cover
        One window if the clip is no longer than that.

    Raises
    ------
    ValueError
        If the numbers do not go together.
    """
    if not 2 <= overlap <= window // 3:
        raise ValueError(f"overlap must be 2 to a third of the window of {window} frames, got {overlap}")
    if n_frames <= window:
        return Cover(np.zeros(1), np.array([max(n_frames - 1, 1)], dtype=np.float64))
    n_windows = 1 + int(np.ceil((n_frames - window) / (window - overlap)))
    length = int(np.ceil((n_frames + (n_windows - 1) * overlap) / n_windows))
    starts = np.round(np.linspace(0, n_frames - length, n_windows))
    return Cover(starts, starts + length - 1)
