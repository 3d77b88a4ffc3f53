"""The signals of a clip, fitted: what evaluating needs and what edits change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh
from tempose.curves import MonotoneMap, Spline
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.time.origin import Origin
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Signals:
    """A clip as signals of time, pose and shape. Edits return new ones; nothing here ever changes.

    Three clocks: *seconds* of what is played; *beats* ``s * rate``, frames at the rate of the captured clip;
    *ticks*, where in the (edited) curve a beat reads, through `retimings`.
    """

    shape: ShapeSignal
    """h."""
    pose: PoseSignal
    """g."""
    time: TimeSignal
    """f, over ticks."""
    path: Spline | None
    """(m) over ticks: the time spline x_c; None plays g(f(t)) alone, as in the paper."""
    placement: Spline | None
    """(7) over ticks: a rotation (wxyz, not yet unit) and a translation (metres); None: inside the shape."""
    retimings: tuple[MonotoneMap, ...]
    """Beats to ticks, the outermost first; empty: a beat is a tick."""
    rate: float
    """Ticks a second: frames per second of the captured clip."""
    fps: float
    """Frames per second of what is played."""
    mesh: Mesh
    """Topology, UVs, groups and name of what is played."""
    origin: Origin | None = None
    """Ticks to ticks of the captured clip, once pieces of it were cut, pasted or repeated; None: the same."""

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        first = self.retimings[0] if self.retimings else self.time.pace
        return (first.domain[1] - first.domain[0]) / self.rate

    @property
    def n_frames(self) -> int:
        """Frames of what is played, both ends counted."""
        return int(np.floor(self.duration * self.fps + 1e-6)) + 1

    @property
    def times(self) -> FloatArray:
        """(T,) seconds of the frames played."""
        return np.arange(self.n_frames) / self.fps

    def ticks(self, seconds: FloatArray) -> FloatArray:
        """Return where in the curve times read.

        Parameters
        ----------
        seconds : (...) float
            Times of what is played.

        Returns
        -------
        (...) ndarray
            Ticks.
        """
        t = np.asarray(seconds, dtype=np.float64) * self.rate
        for retiming in self.retimings:
            t = retiming(t)
        return t

    def coordinates(self, seconds: FloatArray) -> FloatArray:
        """Return the shape coordinates at times.

        Parameters
        ----------
        seconds : (...) float
            Times of what is played.

        Returns
        -------
        (..., m) ndarray
            ``x_c + g(f) - g(f_0)``; without a path, g(f).
        """
        t = self.ticks(seconds)
        captured = t if self.origin is None else self.origin(t)
        x = self.pose(self.time(t), captured)
        if self.path is None:
            return x
        return self.path(t) + (x - self.pose(self.time.before_edits(t), captured))
