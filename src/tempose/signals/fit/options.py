"""What a fit is told, checked before anything is computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.shape_spaces import SPACES
from tempose.typing import FloatArray

TOLERANCE = 0.5
"""Percent of the diagonal, where neither a tolerance nor all of k, l and m are given."""

BETWEEN = ("path", "paper", "dense")
"""What is played between the frames."""

LAYOUTS = ("auto", "mds")
"""How the frames find their places in the pose plane."""


@dataclass(frozen=True)
class FitOptions:
    """How a clip is to be turned into signals; see `SignalModel`."""

    space: str
    tolerance: float | None
    k: int | None
    l: int | None
    m: int | None
    between: str
    layout: str
    placement: bool
    period: float | str | None
    window: int

    def __post_init__(self) -> None:
        if self.space not in SPACES:
            raise ValueError(f"space must be one of {', '.join(SPACES)}, got {self.space!r}")
        if self.between not in BETWEEN:
            raise ValueError(f"between must be one of {', '.join(BETWEEN)}, got {self.between!r}")
        if self.layout not in LAYOUTS:
            raise ValueError(f"layout must be one of {', '.join(LAYOUTS)}, got {self.layout!r}")
        if self.tolerance is not None and not (_number(self.tolerance) and 0 < self.tolerance < math.inf):
            raise ValueError(
                f"tolerance must be positive, percent of the diagonal, got {self.tolerance}; "
                "for exact frames give k = T + 2, l = T and m = T - 1 of a clip of T frames"
            )
        if self.tolerance is not None and None not in (self.k, self.l, self.m):
            raise ValueError("give a tolerance or all of k, l and m, not both: nothing is left to choose")
        ranges = (("k", self.k, 4, "T + 2"), ("l", self.l, 3, "T"), ("m", self.m, 0, "T - 1"))
        for name, value, low, high in ranges:
            if value is not None and (not _whole(value) or value < low):
                raise ValueError(
                    f"{name} must be a whole number from {low} to {high} for a clip of T frames, "
                    f"got {value!r}"
                )
        if not (self.period in ("auto", None) or (_number(self.period) and float(self.period or 0) > 1)):
            raise ValueError(f"period must be 'auto', None or more than 1 frame, got {self.period!r}")
        if not _whole(self.window) or self.window < 16:
            raise ValueError(f"window must be 16 frames or more, got {self.window!r}")

    @property
    def percent(self) -> float:
        """The tolerance, rms percent of the diagonal."""
        return TOLERANCE if self.tolerance is None else float(self.tolerance)

    @property
    def complete(self) -> bool:
        """Whether k and l are given, so that nothing about the pose plane is left to choose."""
        return self.k is not None and self.l is not None

    def check_frames(self, T: int, largest_m: int | None = None) -> None:
        """Check the numbers against a clip.

        Parameters
        ----------
        T : int
            Frames of the clip.
        largest_m : int, optional
            What m is at most; T - 1 if not given.

        Raises
        ------
        ValueError
            If a number is out of its range; the message says the range.
        """
        if T < 2:
            raise ValueError(f"a clip needs 2 frames or more to become signals, got {T}")
        if self.between == "dense" and self.l is not None and self.l > 4 * T - 3:
            raise ValueError(
                f"l must be from 3 to {4 * T - 3} for {T} frames between which g is fitted, got {self.l}"
            )
        if self.period not in (None, "auto") and float(self.period) >= T - 1:
            raise ValueError(
                f"period must be below {T - 1} frames for a clip of {T}, got {self.period}; "
                "leave it to 'auto'"
            )
        top = T - 1 if largest_m is None else largest_m
        limits = (("k", self.k, 4, T + 2), ("l", self.l, 3, max(T, 3)), ("m", self.m, 0, top))
        for name, value, low, high in limits:
            if value is not None and value > high and not (name == "l" and self.between == "dense"):
                raise ValueError(f"{name} must be from {low} to {high} for a clip of {T} frames, got {value}")


def check_pins(pins: Mapping[int, Any] | None, T: int) -> dict[int, FloatArray]:
    """Check the places given to frames.

    Parameters
    ----------
    pins : mapping of int to (x, y), optional
        Frame, 0-based, to its place in the pose plane.
    T : int
        Frames of the clip.

    Returns
    -------
    dict of int to (2,) ndarray
        The same, in the order of frames.

    Raises
    ------
    ValueError
        If a frame does not exist or a place is not two finite numbers.
    """
    checked: dict[int, FloatArray] = {}
    for frame, place in sorted((pins or {}).items()):
        if not _whole(frame) or not 0 <= frame < T:
            raise ValueError(f"pins must name frames from 0 to {T - 1}, got {frame!r}")
        try:
            at = np.asarray(place, dtype=np.float64)
        except (TypeError, ValueError):
            at = np.zeros(0)
        if at.shape != (2,) or not np.isfinite(at).all():
            raise ValueError(f"pins[{frame}] must be two finite numbers x, y, got {place!r}")
        checked[int(frame)] = at
    return checked


def _whole(value: Any) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _number(value: Any) -> bool:
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
