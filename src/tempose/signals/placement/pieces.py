"""A clip put together from pieces goes on where the piece before it ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tempose.curves import Seam, Spline, splice_spline
from tempose.rotations import conjugate, from_rotation_vector, multiply, rotate, swing_twist
from tempose.signals.placement.spline import placement_at
from tempose.typing import FloatArray

Piece = tuple[float, float]

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
        moved = _turned(self.turn, placements)
        moved[..., 4:] += self.shift
        return moved

    def back(self, changes: FloatArray) -> FloatArray:
        """Turn changes of placements, or velocities, back to what they were before the motion.

        Parameters
        ----------
        changes : (..., 7) float
            Differences of placements.

        Returns
        -------
        (..., 7) ndarray
            Differences of the placements that are moved.
        """
        return _turned(conjugate(self.turn), changes)


def splice_placement(
    placement: Spline, pieces: Sequence[Piece], seams: Sequence[Seam], *, closed: bool = False
) -> Spline:
    """Return pieces of a placement one after another, each starting where the one before ended.

    Parameters
    ----------
    placement : Spline
        (7) over ticks.
    pieces : sequence of (start, stop)
        In ticks; a stop before the start runs backwards.
    seams : sequence of Seam
        One between any two pieces, and one more from the last to the first where closed.
    closed : bool, default False
        Whether the end shall run on into the start. A body that has moved on does not return: what meets is
        how it moves, so that the next round can start where this one ends.

    Returns
    -------
    Spline
        (7) from 0, C2.
    """
    gaps = [seam.gap for seam in seams]
    motions = ground_motions(placement, [*pieces, pieces[0]] if closed else pieces, gaps)
    return splice_spline(placement, pieces, seams, closed=closed, motions=motions)


def ground_motions(
    placement: Spline, pieces: Sequence[Piece], gaps: Sequence[float] | None = None
) -> list[GroundMotion]:
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
    gaps : sequence of float, optional
        Ticks that pass between pieces; the body goes on through them as it does on both sides.

    Returns
    -------
    list of GroundMotion
        One for each piece; that of the first moves nothing.
    """
    motions = [GroundMotion(np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3))]
    for i in range(1, len(pieces)):
        left = _states(placement, pieces[i - 1], motions[-1])[1]
        right = _states(placement, pieces[i], motions[0])[0]
        motions.append(_onto(left, right, 0.0 if gaps is None else gaps[i - 1]))
    return motions


@dataclass(frozen=True, eq=False)
class _State:
    """Where a body is, and how it moves along the ground."""

    q: FloatArray
    t: FloatArray
    velocity: FloatArray
    yaw_rate: float


def _states(placement: Spline, piece: Piece, motion: GroundMotion) -> tuple[_State, _State]:
    way = 1.0 if piece[1] > piece[0] else -1.0
    at = np.array(piece)
    values, raw = motion(placement_at(placement, at)), _turned(motion.turn, placement(at))
    rates = _turned(motion.turn, placement(at, 1)) * way
    spin = 2.0 * multiply(rates[:, :4], conjugate(raw[:, :4])) / np.square(raw[:, :4]).sum(1, keepdims=True)
    both = [_State(values[k, :4], values[k, 4:], rates[k, 4:], float(spin[k, 2])) for k in range(2)]
    return both[0], both[1]


def _onto(left: _State, right: _State, gap: float) -> GroundMotion:
    further = from_rotation_vector(0.5 * gap * (left.yaw_rate + right.yaw_rate) * UP)
    end = multiply(further, left.q)
    turn = swing_twist(multiply(end, conjugate(right.q)), UP)[1]
    there = left.t + 0.5 * gap * (left.velocity + rotate(turn, right.velocity))
    return GroundMotion(turn, (there - rotate(turn, right.t)) * (1.0 - UP))


def _turned(turn: FloatArray, placements: FloatArray) -> FloatArray:
    placements = np.asarray(placements, dtype=np.float64)
    return np.concatenate([multiply(turn, placements[..., :4]), rotate(turn, placements[..., 4:])], axis=-1)
