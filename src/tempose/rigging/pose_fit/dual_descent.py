"""Poses of a dual-quaternion skin, from those of the linear skin downhill."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.clips.blocks import cut_blocks, read_block
from tempose.kinematics import rest_transforms
from tempose.kinematics.dual_quaternion import rows_by_strength
from tempose.rigging.pose_fit.descent import MOST_DAMPING
from tempose.rigging.pose_fit.dual_kernels import dual_energy
from tempose.rigging.pose_fit.linear_kernels import bone_rows, twist_quadratic
from tempose.rigging.pose_fit.matrix_kernels import orthonormalise
from tempose.rigging.pose_fit.moments import FrameMoments, SkinMoments
from tempose.rigging.pose_fit.tree_kernels import (
    damped_step,
    normal_equations,
    place,
    turn_joints,
)
from tempose.typing import BoolArray, FloatArray, IntArray, Progress

_BLOCK = 1_000_000


def descend_dual(
    made: SkinMoments,
    seen: FrameMoments,
    frames: FloatArray,
    A: FloatArray,
    bones: FloatArray,
    R: FloatArray,
    root: FloatArray,
    values: FloatArray,
    iterations: IntArray,
    converged: BoolArray,
    most: int,
    tolerance: float,
    progress: Progress,
) -> None:
    """Bring the poses of a linear skin to the least error of the dual-quaternion skin.

    Parameters
    ----------
    made : SkinMoments
        Of the skin, n vertices and J joints.
    seen : FrameMoments
        Of T frames.
    frames : (T, n, 3) float
        Those frames, metres.
    A : (4 J, 4 J) float
        Second moments about the joints.
    bones : (J, 3) float
        From `bone_steps`.
    R : (T, J, 3, 3) float
        Turns of the bones: the start, then the result.
    root : (T, 3) float
        Positions of the root from the centre of each frame: the start, then the result.
    values : (T,) float
        Sums of squared distances, written.
    iterations : (T,) int
        Steps, added.
    converged : (T,) bool
        Written.
    most : int
        Largest number of steps.
    tolerance : float
        Part of the energy that ends the descent.
    progress : Progress
        Told about every block of frames.

    Notes
    -----
    The gradient is exact, the second derivatives are those of the linear skin in the same pose, which the
    moments give for nothing: the same minimum as Gauss-Newton, a few more steps.
    """
    skeleton = made.skin.skeleton
    joints = rest_transforms(skeleton)[1] - made.centre
    parents = skeleton.parents.astype(np.int64)
    rows = rows_by_strength(made.skin.weights)
    V = made.skin.mesh.vertices - made.centre
    for part in cut_blocks(len(seen), V.size, _BLOCK):
        Y = read_block(frames, part, "frames") - seen.centres[part, None]
        for t in range(part.start, part.stop):
            values[t], used, converged[t] = _descend(
                *rows,
                V,
                Y[t - part.start],
                seen.energies[t],
                A,
                joints,
                parents,
                bones,
                R[t],
                root[t],
                most,
                tolerance,
            )
            iterations[t] += used
        progress(part.stop, len(seen), "dual quaternions")


@njit(cache=True, nogil=True)
def _descend(
    starts: IntArray,
    owners: IntArray,
    weights: FloatArray,
    V: FloatArray,
    Y: FloatArray,
    constant: float,
    A: FloatArray,
    joints: FloatArray,
    parents: IntArray,
    steps: FloatArray,
    R: FloatArray,
    root: FloatArray,
    most: int,
    tolerance: float,
) -> tuple[float, int, bool]:
    J = len(parents)
    N = 3 * J + 3
    q, M, none = np.zeros((J, 3)), np.zeros((4 * J, 3)), np.zeros((4 * J, 3))
    q2, R2, real, dual = np.zeros((J, 3)), np.zeros((J, 3, 3)), np.zeros((J, 4)), np.zeros((J, 4))
    K, F, F2, F0 = np.zeros((J, J, 36)), np.zeros((J, 6)), np.zeros((J, 6)), np.zeros((J, 6))
    H, L, g, step = np.zeros((N, N)), np.zeros((N, N)), np.zeros(N), np.zeros(N)
    place(R, root, parents, steps, q)
    _dual_quaternions(R, q, joints, real, dual)
    value = dual_energy(starts, owners, weights, real, dual, V, Y, F)
    damping, fresh = 0.0, True
    for i in range(most):
        if fresh:
            bone_rows(R, q, M)
            twist_quadratic(A, M, none, K, F0)
            F2[:] = F
            normal_equations(K, F2, q, parents, H, g)
        fall = damped_step(H, g, damping, L, step)
        if fall <= tolerance * value + 1e-14 * constant:
            return value, i, True
        turn_joints(step, parents, R, R2)
        orthonormalise(R2)
        root2 = root + step[3 * J :]
        place(R2, root2, parents, steps, q2)
        _dual_quaternions(R2, q2, joints, real, dual)
        value2 = dual_energy(starts, owners, weights, real, dual, V, Y, F2)
        fresh = value2 <= value
        if fresh:
            done = value - value2 <= tolerance * value
            R[:], root[:], q[:], F[:], value = R2, root2, q2, F2, value2
            if done:
                return value, i + 1, True
            damping = 0.0 if damping < 1e-3 else 0.1 * damping
        else:
            damping = max(1e-2, 10 * damping)
            if damping > MOST_DAMPING:
                return value, i + 1, False
    return value, most, False


@njit(cache=True, nogil=True)
def _dual_quaternions(
    R: FloatArray, q: FloatArray, joints: FloatArray, real: FloatArray, dual: FloatArray
) -> None:
    for j in range(len(R)):
        T, r = R[j], real[j]
        trace = T[0, 0] + T[1, 1] + T[2, 2]
        best = 0
        for k in range(1, 3):
            if T[k, k] > T[best, best]:
                best = k
        if trace >= T[best, best]:
            r[0], r[1], r[2], r[3] = 1 + trace, T[2, 1] - T[1, 2], T[0, 2] - T[2, 0], T[1, 0] - T[0, 1]
        else:
            a, b = (best + 1) % 3, (best + 2) % 3
            r[0] = T[b, a] - T[a, b]
            r[1 + best] = 1 + 2 * T[best, best] - trace
            r[1 + a], r[1 + b] = T[a, best] + T[best, a], T[b, best] + T[best, b]
        r /= np.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3])
        x, y, z = q[j] - T @ joints[j]
        dual[j, 0] = -0.5 * (x * r[1] + y * r[2] + z * r[3])
        dual[j, 1] = 0.5 * (x * r[0] + y * r[3] - z * r[2])
        dual[j, 2] = 0.5 * (y * r[0] + z * r[1] - x * r[3])
        dual[j, 3] = 0.5 * (z * r[0] + x * r[2] - y * r[1])
