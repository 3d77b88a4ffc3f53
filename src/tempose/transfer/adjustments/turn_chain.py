"""Bones of the trunk, or a single bone, that share a turn so that a point comes near its place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rotations import from_rotation_vector, multiply, rotate, shortest_rotation, to_rotation_vector
from tempose.transfer.bodies.bones import Bones
from tempose.transfer.bodies.limb_ik import bones_below
from tempose.typing import FloatArray

TRUNK_STRETCH = 0.06
"""Share of the length by which the surface makes up for what turning cannot do: a back gives way more than
a forearm."""
_STEPS = 12


@dataclass(frozen=True)
class TurnChain:
    """Bones along the trunk, or one bone, share a turn."""

    pivots: tuple[int, ...]
    """Bones that turn, from the body outwards, each by an equal part more than the one before."""
    joints: FloatArray
    """(k + 2, 3) metres at rest: where each of the k starts, the joint of the part, the point."""
    bone: int
    """Bone that carries the point."""
    bones: Bones
    """All bones."""
    stretch: float = TRUNK_STRETCH
    """Share of the length by which the surface makes up freely for what the bones cannot do."""

    @property
    def top(self) -> int:
        """Bone at which the chain starts."""
        return self.pivots[0]

    @property
    def length(self) -> float:
        """Length of the chain, metres."""
        return float(np.linalg.norm(np.diff(self.joints, axis=0), axis=1).sum())

    def move(self, Q: FloatArray, shift: FloatArray, follow: bool) -> FloatArray:
        """Turn the bones so that the point moves.

        Parameters
        ----------
        Q : (..., B, 4) float
            Rotations of the bones.
        shift : (..., 3) float
            Where the point shall go from where it is, metres.
        follow : bool
            Whether the part itself turns with the last of them.

        Returns
        -------
        (..., B, 4) ndarray
            Rotations. The point goes as near as the length of the chain allows.
        """
        carriers, v = [*self.pivots, self.bone], self._spans(Q)
        k = len(self.pivots)
        shares = (np.arange(k) + 1.0) / k
        if follow or self.pivots[-1] == self.bone:
            shares = np.r_[shares, 1.0]
        else:
            shares = np.r_[shares, 0.0]
        turn = self._turn(v, v.sum(axis=-2) + shift, shares)
        out = np.array(Q, dtype=np.float64)
        for i, (b, share) in enumerate(zip(carriers, shares)):
            if i == k and b == self.pivots[-1]:
                continue
            mine = set(bones_below(self.bones.parents, b).tolist())
            if i < k and carriers[i + 1] != b:
                mine -= set(bones_below(self.bones.parents, carriers[i + 1]).tolist())
            chosen = sorted(mine)
            step = from_rotation_vector(share * turn)[..., None, :]
            out[..., chosen, :] = multiply(step, Q[..., chosen, :])
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
            What is across the chain: turning does not change its length.
        """
        axis = self._spans(Q).sum(axis=-2)
        axis = axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12)
        return missing - np.sum(missing * axis, axis=-1, keepdims=True) * axis

    def _spans(self, Q: FloatArray) -> FloatArray:
        carriers = [*self.pivots, self.bone]
        spans = np.diff(self.joints, axis=0)
        return np.stack([rotate(Q[..., b, :], span) for b, span in zip(carriers, spans)], axis=-2)

    @staticmethod
    def _turn(v: FloatArray, goal: FloatArray, shares: FloatArray) -> FloatArray:
        """Rotation vector w for which ``sum exp(share_i w) v_i`` points to the goal."""
        turn = np.zeros(goal.shape)
        for _ in range(_STEPS if len(np.unique(shares)) > 1 else 1):
            got = rotate(from_rotation_vector(shares[:, None] * turn[..., None, :]), v).sum(axis=-2)
            step = to_rotation_vector(shortest_rotation(got, goal))
            turn = to_rotation_vector(multiply(from_rotation_vector(step), from_rotation_vector(turn)))
        return turn
