"""What the loops of posing need of every joint: how it has moved since the bind pose."""

from __future__ import annotations

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, multiply, rotate, to_matrix
from tempose.typing import FloatArray


def joint_turns(skin: SkinnedMesh, motion: SkeletonClip) -> tuple[FloatArray, FloatArray]:
    """Return how every joint has turned and moved since the bind pose.

    Parameters
    ----------
    skin : SkinnedMesh
        J joints at rest in the bind pose.
    motion : SkeletonClip
        T frames on the same joints; its own offsets are used.

    Returns
    -------
    turns : (T, J, 4) ndarray
        Rotations wxyz from the bind pose; the sign of each agrees with that of its parent, so that blends
        of neighbours go the short way.
    shifts : (T, J, 3) ndarray
        What is added after the turn about the root's rest position, less the root's position: small
        numbers, however far the body has walked.
    """
    bind_turn, bind_place = rest_transforms(skin.skeleton)
    world, place = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)
    turns = multiply(world, conjugate(bind_turn))
    for j in range(1, skin.skeleton.n_joints):
        p = int(skin.skeleton.parents[j])
        against = (turns[:, j] * turns[:, p]).sum(axis=-1) < 0
        turns[against, j] *= -1.0
    shifts = place - motion.root_position[:, None] - rotate(turns, bind_place - bind_place[0])
    return turns, shifts


def linear_rows(turns: FloatArray, shifts: FloatArray) -> FloatArray:
    """Lay out joints for linear blend skinning.

    Parameters
    ----------
    turns : (T, J, 4) float
        Rotations.
    shifts : (T, J, 3) float
        Shifts.

    Returns
    -------
    (T, J, 16) ndarray
        Matrix by rows, shift, quaternion.
    """
    matrices = to_matrix(turns).reshape(*turns.shape[:-1], 9)
    return np.concatenate([matrices, shifts, turns], axis=-1)


def dual_rows(turns: FloatArray, shifts: FloatArray) -> FloatArray:
    """Lay out joints for dual-quaternion skinning.

    Parameters
    ----------
    turns : (T, J, 4) float
        Rotations.
    shifts : (T, J, 3) float
        Shifts.

    Returns
    -------
    (T, J, 8) ndarray
        Unit dual quaternions, real part and dual part.
    """
    pure = np.concatenate([np.zeros((*shifts.shape[:-1], 1)), shifts], axis=-1)
    return np.concatenate([turns, 0.5 * multiply(pure, turns)], axis=-1)
