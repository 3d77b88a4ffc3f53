"""Places for words and small pictures where they hide nothing."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose.typing import FloatArray


@dataclass(eq=False)
class Crowd:
    """What stands in a picture already: points and boxes."""

    points: FloatArray
    """(n, 2) pixels that should stay free, such as a curve."""
    bounds: tuple[float, float, float, float]
    """Left, top, right, bottom of what may be used."""
    boxes: list[tuple[float, float, float, float]] = field(
        default_factory=list[tuple[float, float, float, float]]
    )
    """Taken already."""

    def cost(self, at: FloatArray, half: tuple[float, float]) -> float:
        """Return how much a box would hide.

        Parameters
        ----------
        at : (2,) float
            Its middle, pixels.
        half : (float, float)
            Half its width and height, pixels.

        Returns
        -------
        float
            Points inside, each other box that it touches counted as many; infinite outside the bounds.
        """
        left, top, right, bottom = at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1]
        x0, y0, x1, y1 = self.bounds
        if left < x0 or top < y0 or right > x1 or bottom > y1:
            return float("inf")
        hidden = (np.abs(self.points - at) < half).all(axis=1).sum()
        touched = sum(not (right < a or left > c or bottom < b or top > d) for a, b, c, d in self.boxes)
        return float(hidden + 1000 * touched)

    def settle(
        self, anchor: FloatArray, half: tuple[float, float], distances: tuple[float, ...], limit: float = 0.0
    ) -> FloatArray | None:
        """Find the place for a box beside a point, and take it.

        Parameters
        ----------
        anchor : (2,) float
            What the box belongs to, pixels.
        half : (float, float)
            Half its width and height, pixels.
        distances : tuple of float
            How far from the anchor its nearer side may be, pixels; the first is liked most.
        limit : float, default 0
            Points that it may hide.

        Returns
        -------
        (2,) ndarray or None
            Its middle; None where there is no room.
        """
        best, least = None, limit + 1e-6
        for k, distance in enumerate(distances):
            for angle in np.arange(16) * (np.pi / 8) - np.pi / 2:
                direction = np.array([np.cos(angle), np.sin(angle)])
                at = anchor + direction * (distance + np.abs(direction * half).sum())
                cost = self.cost(at, half) + 0.01 * k
                if cost < least:
                    best, least = at, cost
        if best is not None:
            left, top, right, bottom = *(best - half), *(best + half)
            self.boxes.append((float(left), float(top), float(right), float(bottom)))
        return best
