"""A pose from the moments of one frame alone, joint by joint from the root outwards."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.rigging.pose_fit.nearest_rotation import nearest_rotation
from tempose.rigging.pose_fit.tree_kernels import place
from tempose.typing import FloatArray, IntArray


def bone_sums(A: FloatArray) -> FloatArray:
    """Sum the weighted vertices of every bone.

    Parameters
    ----------
    A : (4 J, 4 J) float
        Second moments about the joints; rows of weights sum to 1.

    Returns
    -------
    (J, 4) ndarray
        ``sum_v w_vj [x_v - p_j, 1]``.
    """
    return A[:, 3::4].sum(axis=1).reshape(-1, 4)


@njit(cache=True, nogil=True)
def closed_form_start(
    sums: FloatArray,
    B: FloatArray,
    parents: IntArray,
    steps: FloatArray,
    hinged: bool,
    R: FloatArray,
    root: FloatArray,
) -> None:
    """Turn every bone as its own share of the frame asks, then shift the whole.

    Parameters
    ----------
    sums : (J, 4) float
        From `bone_sums`.
    B : (4 J, 3) float
        First moments of the frame.
    parents : (J,) int
        Parents first.
    steps : (J, 3) float
        From the parent to the joint in the bind pose.
    hinged : bool
        Whether a bone turns about the joint where its parent put it, or about the mean of what it carries.
    R : (J, 3, 3) float
        Turns of the bones, written.
    root : (3,) float
        Position of the root, written.

    Notes
    -----
    Weighted Procrustes of the vertices of each bone on their targets, as if the bone alone carried them. A
    bone that carries nothing turns with its parent; the root then as all bones together.
    """
    J = len(parents)
    N, q = np.zeros((3, 3)), np.zeros((J, 3))
    whole = sums[0, 3] <= 0
    for j in range(J):
        if sums[j, 3] <= 0 and j > 0:
            R[j] = R[parents[j]]
            q[j] = q[parents[j]] + R[parents[j]] @ steps[j]
            continue
        if j > 0:
            q[j] = q[parents[j]] + R[parents[j]] @ steps[j]
        if j == 0 and whole:
            _whole_covariance(sums, B, parents, steps, N)
        else:
            w = sums[j, 3]
            y = q[j] if hinged and j > 0 else B[4 * j + 3] / w
            for a in range(3):
                for b in range(3):
                    N[a, b] = B[4 * j + b, a] - y[a] * sums[j, b]
        nearest_rotation(N, R[j])
        if j == 0 and not whole:
            q[0] = (B[3] - R[0] @ sums[0, :3]) / sums[0, 3]
    _shift_to_mean(sums, B, parents, steps, R, root)


@njit(cache=True, nogil=True)
def _whole_covariance(
    sums: FloatArray, B: FloatArray, parents: IntArray, steps: FloatArray, N: FloatArray
) -> None:
    # the frame is centred, so that any common origin of the bind pose will do: the root
    J = len(parents)
    p = np.zeros((J, 3))
    N[:] = 0
    for j in range(J):
        if j > 0:
            p[j] = p[parents[j]] + steps[j]
        for a in range(3):
            for b in range(3):
                N[a, b] += B[4 * j + b, a] + B[4 * j + 3, a] * p[j, b]


@njit(cache=True, nogil=True)
def _shift_to_mean(
    sums: FloatArray, B: FloatArray, parents: IntArray, steps: FloatArray, R: FloatArray, root: FloatArray
) -> None:
    q = np.zeros((len(parents), 3))
    place(R, np.zeros(3), parents, steps, q)
    total, left = 0.0, np.zeros(3)
    for j in range(len(parents)):
        total += sums[j, 3]
        left += B[4 * j + 3] - R[j] @ sums[j, :3] - sums[j, 3] * q[j]
    root[:] = left / total
