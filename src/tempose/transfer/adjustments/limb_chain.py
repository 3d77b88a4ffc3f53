"""A limb of two bones that reaches for a place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rotations import from_rotation_vector, multiply, rotate
from tempose.transfer.bodies.limb_ik import Limb, reach
from tempose.typing import FloatArray

STRETCH = 0.02
"""Share of its length by which a limb stretches freely to where it was asked, and at most twice as far."""


@dataclass(frozen=True)
class LimbChain:
    """Two bones reach for a place."""

    limb: Limb
    """The limb; its end is the wrist or ankle, or the point itself where the lower bone carries it."""
    bone: int
    """Bone that carries the point."""
    beyond: FloatArray
    """(3,) metres at rest, from the limb's end to the point."""
    stretch: float = STRETCH
    """Share of the length by which the surface makes up freely for what the bones cannot do."""

    @property
    def top(self) -> int:
        """Bone at which the chain starts."""
        return self.limb.upper

    @property
    def length(self) -> float:
        """Full reach, metres."""
        limb = self.limb
        return float(np.linalg.norm(limb.second - limb.first) + np.linalg.norm(limb.end - limb.second))

    def move(self, Q: FloatArray, shift: FloatArray, follow: bool) -> FloatArray:
        """Turn the bones so that the point moves.

        Parameters
        ----------
        Q : (..., B, 4) float
            Rotations of the bones.
        shift : (..., 3) float
            Where the point shall go from where it is, metres.
        follow : bool
            Whether hand or foot turn with the lower bone.

        Returns
        -------
        (..., B, 4) ndarray
            Rotations.
        """
        beyond = rotate(Q[..., self.bone, :], self.beyond)
        return reach(self.limb, Q, shift, follow=follow, beyond=beyond if follow else None)

    def swivelled(self, Q: FloatArray, angles: FloatArray) -> FloatArray:
        """Turn the middle joint about the line between both ends, which stay.

        Parameters
        ----------
        Q : (..., B, 4) float
            Rotations of the bones.
        angles : (...) float
            Radians, right-handed about the line from the first joint to the last.

        Returns
        -------
        (..., B, 4) ndarray
            Rotations; hand or foot keep theirs.
        """
        limb, out = self.limb, np.array(Q, dtype=np.float64)
        axis = rotate(Q[..., limb.upper, :], limb.second - limb.first)
        axis = axis + rotate(Q[..., limb.lower, :], limb.end - limb.second)
        axis = axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12)
        turn = from_rotation_vector(np.asarray(angles)[..., None] * axis)
        for b in (limb.upper, limb.lower):
            out[..., b, :] = multiply(turn, Q[..., b, :])
        return out

    def attainable(self, Q: FloatArray, missing: FloatArray) -> FloatArray:
        """Tell which part of a missing displacement is worth asking for.

        Parameters
        ----------
        Q : (..., B, 4) float
            Rotations of the bones.
        missing : (..., 3) float
            What the point still lacks, metres.

        Returns
        -------
        (..., 3) ndarray
            All of it: a limb slows down at full reach by itself.
        """
        return missing
