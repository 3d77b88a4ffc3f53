"""Where bones are: one pose or a whole motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray


@dataclass(frozen=True)
class BonePose:
    """B bones in space; leading axes are frames."""

    turns: FloatArray
    """(..., B, 4) world rotations wxyz; identity for a target, whose rest defines them."""
    starts: FloatArray
    """(..., B, 3) metres."""
    ends: FloatArray
    """(..., B, 3) metres; equal to the start where none is known."""

    @property
    def directions(self) -> FloatArray:
        """(..., B, 3) unit vectors from start to end; zero where no end is known."""
        span = self.ends - self.starts
        length = np.linalg.norm(span, axis=-1, keepdims=True)
        return span / np.where(length > 0, length, 1.0)

    @property
    def lengths(self) -> FloatArray:
        """(..., B) metres."""
        return np.linalg.norm(self.ends - self.starts, axis=-1)

    def frame(self, t: int) -> BonePose:
        """Return one frame of a motion.

        Parameters
        ----------
        t : int
            Frame.

        Returns
        -------
        BonePose
            Without the leading axis.
        """
        return BonePose(self.turns[t], self.starts[t], self.ends[t])
