"""Which bones turn when a point of a body is moved."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from tempose.transfer.adjustments.limb_chain import LimbChain
from tempose.transfer.adjustments.turn_chain import TurnChain
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.limb_ik import Limb, bend_axis, bones_below, find_limb
from tempose.transfer.bodies.pose import BonePose
from tempose.typing import FloatArray

_NEAR_JOINT = 0.3
"""A point nearer to the elbow than this share of the forearm is moved by the upper arm alone."""


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
