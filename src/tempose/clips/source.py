"""What a file said about itself, kept so that a result can go back the way it came."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Source:
    """Axis, unit and rate as found in a file, before they were converted."""

    path: str = ""
    """File or pattern it came from; empty for data made in memory."""
    format: str = ""
    """Short format name, such as ``"obj"``."""
    up: str = "y"
    """Up axis in the file, ``"x"``, ``"y"`` or ``"z"``."""
    unit: float = 1.0
    """Metres per unit of the file."""
    fps: float | None = None
    """Frames per second as the file states it, None where it states none."""
    guessed: tuple[str, ...] = ()
    """Which of ``"up"``, ``"unit"``, ``"fps"`` were guessed, not read."""
    notes: tuple[str, ...] = ()
    """What was unusual about the file, one sentence each."""

    def __post_init__(self) -> None:
        if self.up not in ("x", "y", "z"):
            raise ValueError(f"up must be 'x', 'y' or 'z', got {self.up!r}")
        if not 0 < self.unit < float("inf"):
            raise ValueError(f"unit must be a positive number of metres, got {self.unit}")
        if self.fps is not None and not 0 < self.fps < float("inf"):
            raise ValueError(f"fps must be positive, got {self.fps}")
