"""Newton steps of one pose of a linear blend skin, on moments alone."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.rigging.pose_fit.linear_kernels import add_curvature, bone_rows, energy, twist_quadratic
from tempose.rigging.pose_fit.matrix_kernels import orthonormalise
from tempose.rigging.pose_fit.tree_kernels import damped_step, normal_equations, place, turn_joints
from tempose.typing import FloatArray, IntArray

MOST_DAMPING = 1e6
_WORTH = 1e-3


@njit(cache=True, nogil=True)
def descend(
    A: FloatArray,
    B: FloatArray,
    constant: float,
    parents: IntArray,
    steps: FloatArray,
    R: FloatArray,
    root: FloatArray,
    most: int,
    tolerance: float,
    bar: float,
) -> tuple[float, int, bool]:
    """Bring one pose down by Newton steps, damped Gauss-Newton where the energy is not convex.

    Parameters
    ----------
    A : (4 J, 4 J) float
        Second moments about the joints.
    B : (4 J, 3) float
        First moments of the frame.
    constant : float
        Sum of squares of the frame, which completes the energy.
    parents : (J,) int
        Parents first.
    steps : (J, 3) float
        From the parent to the joint in the bind pose.
    R : (J, 3, 3) float
        Turns of the bones: the start, then the result.
    root : (3,) float
        Position of the root: the start, then the result.
    most : int
        Largest number of steps.
    tolerance : float
        Done when a step can take no more than this part of the energy.
    bar : float
        Energy already reached from another start: given up when a step promises no less.

    Returns
    -------
    energy : float
        Sum of squared distances, metres squared.
    iterations : int
        Steps tried.
    converged : bool
        Whether the last step could not lower the energy any more.
    """
    J = len(parents)
    N = 3 * J + 3
    q, M, G = np.zeros((J, 3)), np.zeros((4 * J, 3)), np.zeros((4 * J, 3))
    q2, M2, G2, R2 = np.zeros((J, 3)), np.zeros((4 * J, 3)), np.zeros((4 * J, 3)), np.zeros((J, 3, 3))
    K, F = np.zeros((J, J, 36)), np.zeros((J, 6))
    H, H2, L, g, step = np.zeros((N, N)), np.zeros((N, N)), np.zeros((N, N)), np.zeros(N), np.zeros(N)
    orthonormalise(R)
    place(R, root, parents, steps, q)
    bone_rows(R, q, M)
    value = energy(A, B, M, G) + constant
    damping, fresh = 0.0, True
    for i in range(most):
        if fresh:
            twist_quadratic(A, M, G, K, F)
            normal_equations(K, F, q, parents, H, g)
            add_curvature(M, G, q, parents, H, H2)
        fall = damped_step(H2, g, damping, L, step)
        if fall < 0:
            fall = damped_step(H, g, damping, L, step)
        # the energy itself is known to so many digits only
        if fall <= tolerance * max(value, 0.0) + 1e-14 * constant:
            return value, i, True
        if i > 0 and value - fall > bar * (1 - _WORTH):
            return value, i, False
        turn_joints(step, parents, R, R2)
        root2 = root + step[3 * J :]
        place(R2, root2, parents, steps, q2)
        bone_rows(R2, q2, M2)
        value2 = energy(A, B, M2, G2) + constant
        fresh = value2 <= value
        if fresh:
            R[:], root[:], q[:], M[:], G[:], value = R2, root2, q2, M2, G2, value2
            damping = 0.0 if damping < 1e-3 else 0.1 * damping
        else:
            damping = max(1e-2, 10 * damping)
            if damping > MOST_DAMPING:
                return value, i + 1, False
    return value, most, False
