"""Legs of the target: what gives way when a foot is displaced, and how far it reaches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.transfer.bodies.bones import Bones
from tempose.transfer.bodies.joint_regressor import apply_regressor, regress_points
from tempose.transfer.bodies.pose import BonePose
from tempose.typing import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Leg:
    """One leg; a body without bones has no joints to it."""

    foot: IntArray
    """(k,) vertices that follow a displacement wholly."""
    limb: IntArray
    """Vertices between foot and body that give way; all others keep their place."""
    ankle: tuple[IntArray, FloatArray]
    """Vertices and weights, each (1, s), of a point of the foot."""
    hip: tuple[IntArray, FloatArray] | None = None
    """The same of the joint where the leg begins."""
    length: float = np.inf
    """Metres from hip to ankle, stretched."""

    def ankles(self, V: FloatArray) -> FloatArray:
        """Place of the ankle.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames.

        Returns
        -------
        (T, 3) ndarray
            Metres.
        """
        return apply_regressor(V, *self.ankle)[:, 0]

    def hips(self, V: FloatArray) -> FloatArray | None:
        """Place of the hip joint.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames.

        Returns
        -------
        (T, 3) ndarray or None
            Metres; None for a leg without joints.
        """
        return None if self.hip is None else apply_regressor(V, *self.hip)[:, 0]


def bone_leg(bones: Bones, group: list[int], target: BonePose, owner: IntArray, V: FloatArray) -> Leg:
    """Leg of a body of bones: from the foot up to where the tree branches.

    Parameters
    ----------
    bones : Bones
        B bones.
    group : list of int
        Bones of the foot, the uppermost first.
    target : BonePose
        (B,) target at rest.
    owner : (n,) int
        Bone of largest influence on each vertex.
    V : (n, 3) float
        Target at rest, metres.

    Returns
    -------
    Leg
        Without joints where the foot hangs on the body itself or owns no vertices of a bone.
    """
    foot = np.flatnonzero(np.isin(owner, group))
    chain = _above(bones, group[0])
    limb = np.flatnonzero(np.isin(owner, chain))
    ankle = regress_points(V, target.starts[[group[0]]], [foot])
    top = np.flatnonzero(owner == chain[-1]) if chain else foot[:0]
    if len(top) == 0:
        return Leg(foot, limb, ankle)
    length = float(target.lengths[chain].sum())
    hip = regress_points(V, target.starts[[chain[-1]]], [top])
    return Leg(foot, limb, ankle, hip, length if length > 0 else np.inf)


def _above(bones: Bones, bone: int) -> list[int]:
    """Bones above one up to the last that carries nothing else; never the root."""
    parents = np.asarray(bones.parents)
    chain: list[int] = []
    above = int(parents[bone])
    while above >= 0 and parents[above] >= 0 and (parents == above).sum() == 1:
        chain.append(above)
        above = int(parents[above])
    return chain


def mesh_leg(V: FloatArray, foot: IntArray, others: IntArray) -> Leg:
    """Leg of a body without bones: whatever lies in its lower half.

    Parameters
    ----------
    V : (n, 3) float
        Target at rest, metres.
    foot : (k,) int
        Vertices of the foot.
    others : (j,) int
        Vertices of all other feet.

    Returns
    -------
    Leg
        Without joints.
    """
    low: BoolArray = V[:, 1] < V[:, 1].min() + 0.5 * np.ptp(V[:, 1])
    low[foot] = low[others] = False
    mean = np.full((1, len(foot)), 1 / len(foot))
    return Leg(foot, np.flatnonzero(low), (foot[None], mean))
