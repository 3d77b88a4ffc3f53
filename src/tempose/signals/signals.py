"""The signals of a clip, fitted: what evaluating needs and what edits change."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tempose.clips import Mesh
from tempose.curves import MonotoneMap, Spline
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.time.origin import Origin
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray

FADE = (1.0, 3.0)
"""Steps of the pose plane: a curve moved further than the first begins to lose what the path knows beyond g,
beyond the second it shows g alone. That rest belongs to the pose that was left, not to the one gone to."""


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
    fade_step: float | None = None
    """The step of `FADE`, kept from the first control moved on: cuts and loops change the median step and
    must not change what moved controls show. None: `pose_step`."""

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
            ``g(f) + w (x_c - g(f_0))``; without a path, g(f). Where nobody moved the curve this is x_c,
            bit for bit; w fades from 1 to 0 as the curve leaves its old place, see `FADE`.
        """
        return self.coordinates_at(self.ticks(seconds))

    def coordinates_at(self, ticks: FloatArray) -> FloatArray:
        """Return the shape coordinates at ticks.

        Parameters
        ----------
        ticks : (...) float
            Where in the curve.

        Returns
        -------
        (..., m) ndarray
            As `coordinates` returns them.
        """
        t = np.asarray(ticks, dtype=np.float64)
        captured = t if self.origin is None else np.asarray(self.origin(t))
        if self.path is None:
            return self.pose(self.time(t), captured)
        x = self.path(t)
        if self.time.curve is self.time.unedited:
            return x
        f, before = self.time(t), self.time.before_edits(t)
        moved = (f != before).any(axis=-1)
        if not moved.any():
            return x
        f, before, captured = f[moved], before[moved], captured[moved]
        w = self.share_of_path(np.linalg.norm(f - before, axis=-1))[:, None]
        x[moved] = self.pose(f, captured) + w * (x[moved] - self.pose(before, captured))
        return x

    def share_of_path(self, moved: FloatArray) -> FloatArray:
        """Return how much of what the path knows beyond g still applies at a place.

        Parameters
        ----------
        moved : (...) float
            How far it is from the place whose pose the path shows, in units of the pose plane.

        Returns
        -------
        (...) ndarray
            1 near it, 0 far away: see `FADE`.
        """
        step = self.pose_step if self.fade_step is None else self.fade_step
        start, stop = FADE[0] * step, FADE[1] * step
        s = np.clip((moved - start) / max(stop - start, np.finfo(float).tiny), 0.0, 1.0)
        return 1.0 - s * s * (3.0 - 2.0 * s)

    @cached_property
    def pose_step(self) -> float:
        """Median way of the unedited curve through the pose plane in a tick; places held do not count."""
        first, last = self.time.pace.domain
        places = self.time.before_edits(np.linspace(first, last, max(round(last - first), 1) + 1))
        steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        return float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
