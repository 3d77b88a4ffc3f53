"""Trajectories of points in space."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose._validate import read_only
from tempose.clips._frozen import Frozen
from tempose.clips.source import Source
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class MarkerClip(Frozen):
    """Labelled points over time; a missing sample is NaN."""

    labels: tuple[str, ...]
    """M labels."""
    positions: FloatArray
    """(T, M, 3) float64 metres, NaN where the marker was not seen."""
    fps: float = 30.0
    """Frames per second."""
    name: str = ""
    """Name for a person to read."""
    source: Source = field(default_factory=Source)
    """What the file said."""

    def __post_init__(self) -> None:
        positions = np.asarray(self.positions, dtype=np.float64)
        if positions.ndim != 3 or positions.shape[1:] != (len(self.labels), 3):
            raise ValueError(f"positions must have shape (T, {len(self.labels)}, 3), got {positions.shape}")
        if np.isinf(positions).any():
            raise ValueError("positions must be finite or NaN (missing), found infinity")
        if not 0 < self.fps < float("inf"):
            raise ValueError(f"fps must be positive, got {self.fps}")
        object.__setattr__(self, "labels", tuple(self.labels))
        object.__setattr__(self, "positions", read_only(positions))
        object.__setattr__(self, "fps", float(self.fps))
