"""Bones turned a little further than the source's, so that the surface of the limb arrives where they point.

The glue spreads a bend over the surface between two rings of marks, and the limb lags behind its bone: by 2.5
degrees on average in a walk, by 11 at worst in a jump. How far it lags is very nearly linear in the bends at
both ends of the bone, with coefficients that depend on the target alone. They are learnt once, from some
frames of the clip, and cost nothing afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rotations import conjugate, from_rotation_vector, multiply, shortest_rotation, to_rotation_vector
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.joint_regressor import apply_regressor, regress_points
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.transfer.turns.columns import Columns
from tempose.typing import FloatArray, IntArray

LEAD = 0.6
"""Share of the lag that is made up for: the rest would cost more in stretched skin than it gains."""
LIMB_PARTS = ("upper_arm", "forearm", "thigh", "shin")
_FRAMES, _ROUNDS, _RIDGE = 16, 2, 1e-2


@dataclass(frozen=True)
class Lead:
    """Linear law of how far each bone has to lead."""

    parents: IntArray
    """(B,) tree of bones."""
    matrices: dict[int, FloatArray]
    """Bone to (3 k, 3): from the bends against its k neighbours, in its own frame, to its lead in radians."""

    def turned(self, Q: FloatArray, share: float = LEAD) -> FloatArray:
        """Turn bones further.

        Parameters
        ----------
        Q : (T, B, 4) float
            Rotations of the source's bones, signs agreeing.
        share : float, default 0.6
            Part of the lag to make up for.

        Returns
        -------
        (T, B, 4) ndarray
            Rotations for the marks.
        """
        out = np.array(Q)
        for b, matrix in self.matrices.items():
            vectors = share * (_bends(Q, self.parents, b) @ matrix)
            out[:, b] = multiply(Q[:, b], from_rotation_vector(vectors))
        return out


def learn_lead(
    solver: MotionTransfer,
    columns: Columns,
    bones: Bones,
    motion: BonePose,
    target: BonePose,
    owner: IntArray,
    Q: FloatArray,
) -> Lead:
    """Measure on some frames how far limbs lag behind their bones.

    Parameters
    ----------
    solver : MotionTransfer
        Factorised target.
    columns : Columns
        What its columns stand for.
    bones : Bones
        B bones; arms and legs are looked at, found by their roles.
    motion : BonePose
        (T, B) source.
    target : BonePose
        (B,) target at rest.
    owner : (n,) int
        Bone of largest influence on each vertex.
    Q : (T, B, 4) float
        Rotations of the bones, signs agreeing.

    Returns
    -------
    Lead
        Without any bone where the roles are not known. A bone at rest does not lead.
    """
    limbs = [b for b in range(len(bones.names)) if _can_lead(bones, motion, target, owner, b)]
    if not limbs or len(Q) == 0:
        return Lead(bones.parents, {})
    frames = np.unique(np.linspace(0, len(Q) - 1, _FRAMES).astype(int))
    rest = solver.mesh.vertices
    own: list[IntArray] = [np.flatnonzero(owner == b).astype(np.int64) for b in limbs]
    starts = regress_points(rest, target.starts[limbs], own)
    ends = regress_points(rest, target.ends[limbs], own)
    wanted = motion.directions[frames][:, limbs]
    led, sampled = np.array(Q[frames]), Q[frames]
    for _ in range(_ROUNDS):
        V = solver.pose(_columns_at(columns, Q, led, frames))
        found = apply_regressor(V, *ends) - apply_regressor(V, *starts)
        found /= np.maximum(np.linalg.norm(found, axis=-1, keepdims=True), 1e-12)
        led[:, limbs] = multiply(shortest_rotation(found, wanted), led[:, limbs])
    leads = to_rotation_vector(multiply(conjugate(sampled), led))
    return Lead(bones.parents, {b: _fit(_bends(sampled, bones.parents, b), leads[:, b]) for b in limbs})


def _can_lead(bones: Bones, motion: BonePose, target: BonePose, owner: IntArray, b: int) -> bool:
    known = target.lengths[b] > 0 and bool((motion.lengths[:, b] > 0).all()) and bones.parents[b] >= 0
    return split_role(bones.roles[b])[1] in LIMB_PARTS and bool(known) and bool((owner == b).any())


def _columns_at(columns: Columns, Q: FloatArray, led: FloatArray, frames: IntArray) -> FloatArray:
    """Columns of some frames, their twists followed through the whole clip."""
    whole = np.array(Q)
    whole[frames] = led
    return columns.rotations(whole)[frames]


def _bends(Q: FloatArray, parents: IntArray, b: int) -> FloatArray:
    """How the parent and the first child are turned against a bone, in its frame, (T, 3 k)."""
    beside = [int(parents[b]), *np.flatnonzero(parents == b)[:1]]
    # twice the vector part, not the rotation vector: that one jumps at half a turn
    return np.concatenate([2 * multiply(conjugate(Q[:, b]), Q[:, k])[:, 1:] for k in beside], axis=1)


def _fit(bends: FloatArray, leads: FloatArray) -> FloatArray:
    damp = _RIDGE * len(bends) * np.eye(bends.shape[1])
    return np.linalg.solve(bends.T @ bends + damp, bends.T @ leads)
