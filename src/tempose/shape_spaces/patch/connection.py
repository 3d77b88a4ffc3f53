"""Rotations of patches from the rotations between neighbours."""

from __future__ import annotations

import numpy as np

from tempose.rotations import polar_rotation
from tempose.shape_spaces.patch.patches import Patches
from tempose.typing import FloatArray


def mean_turn(P: FloatArray, shares: FloatArray) -> FloatArray:
    """Rotation of the whole.

    Parameters
    ----------
    P : (..., p, 3, 3) float
        Rotations of patches.
    shares : (p,) float
        Their shares in the area.

    Returns
    -------
    (..., 3, 3) ndarray
        Nearest rotation to the mean.
    """
    return polar_rotation(np.einsum("p,...pij->...ij", shares, P))


def rotations_from_steps(steps: FloatArray, patches: Patches) -> FloatArray:
    """Find rotations of patches whose differences come nearest to given ones.

    Parameters
    ----------
    steps : (T, e, 3, 3) float
        Wanted ``P_a^T P_b`` of every pair of neighbours (a, b).
    patches : Patches
        Who the neighbours are.

    Returns
    -------
    (T, p, 3, 3) ndarray
        Rotations P, the rotation of the whole being arbitrary.

    Notes
    -----
    Minimises the sum of ``w_ab |P_b - P_a step_ab|^2`` with the largest patch held, then takes the nearest
    rotations: exact where the steps agree with each other.
    """
    n_frames, p = len(steps), len(patches.shares)
    a, b = patches.pairs.T
    w = patches.pair_weights[:, None, None]
    H = np.zeros((n_frames, p, p, 3, 3))
    H[:, a, b] = -w * steps
    H[:, b, a] = -w * steps.swapaxes(-1, -2)
    degree = np.bincount(patches.pairs.ravel(), np.repeat(patches.pair_weights, 2), p)
    H[:, np.arange(p), np.arange(p)] = degree[:, None, None] * np.eye(3)
    held = int(patches.shares.argmax())
    free = np.delete(np.arange(p), held)
    matrix = H[:, free][:, :, free].transpose(0, 1, 3, 2, 4).reshape(n_frames, 3 * (p - 1), 3 * (p - 1))
    right = -H[:, free, held].reshape(n_frames, 3 * (p - 1), 3)
    P = np.broadcast_to(np.eye(3), (n_frames, p, 3, 3)).copy()
    if p > 1:
        P[:, free] = polar_rotation(np.linalg.solve(matrix, right).reshape(n_frames, p - 1, 3, 3))
        P[:, free] = P[:, free].swapaxes(-1, -2)
    return P
