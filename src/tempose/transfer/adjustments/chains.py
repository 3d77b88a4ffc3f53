"""Which bones turn when a point of a body is moved, and by how much."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tempose.rotations import from_rotation_vector, multiply, rotate, shortest_rotation, to_rotation_vector
from tempose.transfer.bones import Bones, split_role
from tempose.transfer.limb_ik import Limb, bend_axis, bones_below, find_limb, reach
from tempose.transfer.pose import BonePose
from tempose.typing import FloatArray

_STEPS = 12
STRETCH = 0.02
"""Share of its length by which a limb stretches freely to where it was asked, and at most twice as far."""
TRUNK_STRETCH = 0.06
"""The same for bones that only turn: the back gives way more than a forearm does."""
_NEAR_JOINT = 0.3
"""A point nearer to the elbow than this share of the forearm is moved by the upper arm alone."""


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


def find_chain(
    bones: Bones, target: BonePose, bone: int, point: FloatArray | None, Q: FloatArray
) -> LimbChain | TurnChain | None:
    """Choose the bones by which a point is moved.

    Parameters
    ----------
    bones : Bones
        B bones.
    target : BonePose
        (B,) the target's bones at rest.
    bone : int
        Bone that carries the point.
    point : (3,) float or None
        The point at rest, metres; None for the joint at which the bone starts.
    Q : (T, B, 4) float
        Rotations of the clip, which tell how limbs bend.

    Returns
    -------
    LimbChain, TurnChain or None
        Hands, feet and what hangs on them: the limb. Others: the bones above, without the root; for a point
        away from the joint also its own bone. None where only the root is left.
    """
    start = target.starts[bone]
    at = start if point is None else point
    side, part = split_role(bones.roles[bone])
    end = side + ("foot" if part == "toes" else part)
    limb = find_limb(bones, target, end, Q) if part else _plain_limb(bones, target, bone, Q)
    if limb is not None:
        return LimbChain(limb, bone, at - limb.end)
    if point is not None and part in ("forearm", "shin"):
        limb = find_limb(bones, target, side + ("hand" if part == "forearm" else "foot"), Q)
        if limb is not None and _far_along(limb, point):
            return LimbChain(replace(limb, end=point), bone, np.zeros(3))
    pivots = _above(bones, bone)
    if part in ("forearm", "shin", "upper_arm") or not part:
        pivots = pivots[-1:]
    if point is not None and bones.parents[bone] >= 0:
        pivots = [*pivots, bone]
    if not pivots:
        return None
    joints = [target.starts[b] for b in pivots]
    return TurnChain(tuple(pivots), np.stack([*joints, start, at]), bone, bones)


def _above(bones: Bones, bone: int) -> list[int]:
    found: list[int] = []
    above = int(bones.parents[bone])
    while above >= 0 and bones.parents[above] >= 0:
        found.insert(0, above)
        above = int(bones.parents[above])
    return found


def _far_along(limb: Limb, point: FloatArray) -> bool:
    axis = limb.end - limb.second
    return float((point - limb.second) @ axis) > _NEAR_JOINT * float(axis @ axis)


def _plain_limb(bones: Bones, target: BonePose, bone: int, Q: FloatArray) -> Limb | None:
    """Limb of a body without roles: two bones above that have no other child, below the root."""
    lower = int(bones.parents[bone])
    upper = int(bones.parents[lower]) if lower >= 0 else -1
    if upper < 0 or bones.parents[upper] < 0:
        return None
    if any((bones.parents == b).sum() != 1 for b in (upper, lower)):
        return None
    first, second, end = (target.starts[b] for b in (upper, lower, bone))
    if any(not (b - a).any() for a, b in pairwise((first, second, end))):
        return None
    hinge = bend_axis(second - first, end - second, np.array([0.0, 0.0, 1.0]), Q[:, [upper, lower]])
    return Limb(upper, lower, bones_below(bones.parents, lower)[1:], first, second, end, hinge)
