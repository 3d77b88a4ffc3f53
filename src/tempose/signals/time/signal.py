"""The time signal f: a spline in the pose plane and the pace along it (section 2.3 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

from tempose.curves import MonotoneMap, Spline
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class TimeSignal:
    """``f = curve o pace``, and the same curve as it was before anyone edited it."""

    curve: Spline
    """Control points f_j in the pose plane, parameters u; edits move its controls."""
    unedited: Spline
    """The same knots, the controls as fitted."""
    pace: MonotoneMap
    """rho: ticks (frames of the clip as it was captured, from 0) to parameters u."""

    def __call__(self, ticks: FloatArray) -> FloatArray:
        """Return places in the pose plane.

        Parameters
        ----------
        ticks : (...) float
            Times in frames of the captured clip.

        Returns
        -------
        (..., 2) ndarray
            f at those ticks.
        """
        return self.curve(self.pace(ticks))

    def before_edits(self, ticks: FloatArray) -> FloatArray:
        """Return the places where the unedited curve was.

        Parameters
        ----------
        ticks : (...) float
            Times in frames of the captured clip.

        Returns
        -------
        (..., 2) ndarray
            f_0 at those ticks.
        """
        return self.unedited(self.pace(ticks))
