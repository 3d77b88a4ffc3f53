"""A ground that nothing sinks into: the trunk by the root, hands by their arms, the rest is pressed flat."""

from __future__ import annotations

import numpy as np

from tempose.transfer.bodies.bones import Bones
from tempose.transfer.bodies.limb_ik import bones_below
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.legs import Leg, bone_leg
from tempose.transfer.feet.steady_path import path_above
from tempose.transfer.frames import BLOCK, release
from tempose.typing import FloatArray, IntArray


def find_arms(bones: Bones, target: BonePose, owner: IntArray, V: FloatArray) -> tuple[Leg, ...]:
    """Find hands and the arms that give way when a hand is lifted.

    Parameters
    ----------
    bones : Bones
        B bones.
    target : BonePose
        (B,) target at rest.
    owner : (n,) int
        Bone of largest influence on each vertex.
    V : (n, 3) float
        Target at rest, metres.

    Returns
    -------
    tuple of Leg
        Those of a body with hands.
    """
    hands = [bones.find(side + "hand") for side in ("left_", "right_")]
    arms = (
        bone_leg(bones, [int(b) for b in bones_below(bones.parents, hand)], target, owner, V)
        for hand in hands
        if hand is not None and (owner == hand).any()
    )
    return tuple(arms)


def lowest(V: FloatArray, vertices: IntArray) -> FloatArray:
    """Height of the lowest of some vertices in every frame.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames; an array or a memory map.
    vertices : (k,) int
        Which vertices, at least one.

    Returns
    -------
    (T,) ndarray
        Metres.
    """
    low = np.zeros(len(V))
    for t in range(0, len(V), BLOCK):
        low[t : t + BLOCK] = V[t : t + BLOCK][:, vertices, 1].min(axis=1)
        release(V)
    return low


def lift_above(low: FloatArray, ground: float, fade: float) -> FloatArray:
    """Lift something just enough to stay above the ground, with least acceleration.

    Parameters
    ----------
    low : (T,) float
        Height of its lowest vertex, metres.
    ground : float
        Height of the ground, metres.
    fade : float
        Frames, see `tempose.transfer.feet.steady_path.steady_path`.

    Returns
    -------
    (T,) ndarray
        Metres, never negative; zero throughout where nothing sinks.
    """
    return np.maximum(path_above(ground - low, np.zeros(len(low), dtype=bool), fade), 0.0)
