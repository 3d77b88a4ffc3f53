"""A clip put together from pieces goes on where the piece before it ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tempose.curves import Spline
from tempose.rotations import conjugate, multiply, normalise, rotate, swing_twist
from tempose.signals.placement.spline import placement_at
from tempose.typing import FloatArray

UP = np.array([0.0, 1.0, 0.0])
UP.flags.writeable = False


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """A turn about the vertical and a shift along the ground."""

    turn: FloatArray
    """(4,) unit quaternion wxyz about Y; its sign chooses among the two quaternions of the result."""
    shift: FloatArray
    """(3,) metres, no height."""

    def __call__(self, placements: FloatArray) -> FloatArray:
        """Move placements, or the controls of a spline of them: the motion is affine.

        Parameters
        ----------
        placements : (..., 7) float
            Rotations wxyz of any length and translations, metres.

        Returns
        -------
        (..., 7) ndarray
            The moved placements.
        """
        placements = np.asarray(placements, dtype=np.float64)
        turned = multiply(self.turn, placements[..., :4])
        return np.concatenate([turned, rotate(self.turn, placements[..., 4:]) + self.shift], axis=-1)


def ground_motions(placement: Spline, pieces: Sequence[tuple[float, float]]) -> list[GroundMotion]:
    """Find how to move pieces of a clip so that each starts where the one before ended.

    Only the turn about the vertical and the place on the ground are carried on: heights stay those of the
    clip, however often a piece is repeated.

    Parameters
    ----------
    placement : Spline
        (7) over ticks.
    pieces : sequence of (float, float)
        Ticks where each piece starts and ends, in the order in which they are played; the end may lie
        before the start.

    Returns
    -------
    list of GroundMotion
        One for each piece; that of the first moves nothing.
    """
    motions: list[GroundMotion] = []
    end: FloatArray | None = None
    for a, b in pieces:
        start, stop = placement_at(placement, np.array([a, b]))
        motions.append(
            GroundMotion(np.array([1.0, 0, 0, 0]), np.zeros(3)) if end is None else _onto(start, end)
        )
        end = _unit(motions[-1](stop))
    return motions


def _onto(start: FloatArray, end: FloatArray) -> GroundMotion:
    between = multiply(end[:4], conjugate(start[:4]))
    turn = swing_twist(between, UP)[1]
    if np.dot(multiply(turn, start[:4]), end[:4]) < 0:
        turn = -turn
    shift = end[4:] - rotate(turn, start[4:])
    return GroundMotion(turn, shift * (1.0 - UP))


def _unit(placement: FloatArray) -> FloatArray:
    return np.concatenate([normalise(placement[:4]), placement[4:]])
