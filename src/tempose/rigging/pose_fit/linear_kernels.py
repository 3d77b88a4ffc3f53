"""Gauss-Newton on the moments of a linear blend skin; no vertex is touched."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.rigging.pose_fit.tree_kernels import (
    damped_step,
    normal_equations,
    orthonormalise,
    place,
    turn_joints,
)
from tempose.typing import FloatArray, IntArray

MOST_DAMPING = 1e6
_WORTH = 1e-3


@njit(cache=True, nogil=True)
def bone_rows(R: FloatArray, q: FloatArray, M: FloatArray) -> None:
    """Stack the transposed matrices of bones about their joints.

    Parameters
    ----------
    R : (J, 3, 3) float
        Turns of the bones.
    q : (J, 3) float
        Joints.
    M : (4 J, 3) float
        Written: three rows of ``R^T`` and one of ``q`` a bone.
    """
    for j in range(len(q)):
        for c in range(3):
            for i in range(3):
                M[4 * j + i, c] = R[j, c, i]
            M[4 * j + 3, c] = q[j, c]


@njit(cache=True, nogil=True)
def energy(A: FloatArray, B: FloatArray, M: FloatArray, G: FloatArray) -> float:
    """Evaluate ``<M, A M> - 2 <M, B>`` and half its gradient.

    Parameters
    ----------
    A : (4 J, 4 J) float
        Second moments.
    B : (4 J, 3) float
        First moments of the frame.
    M : (4 J, 3) float
        Bone matrices.
    G : (4 J, 3) float
        ``A M - B``, written.

    Returns
    -------
    float
        Energy less the constant of the frame.
    """
    total = 0.0
    for i in range(len(M)):
        x = y = z = 0.0
        for k in range(len(M)):
            a = A[i, k]
            x += a * M[k, 0]
            y += a * M[k, 1]
            z += a * M[k, 2]
        G[i, 0], G[i, 1], G[i, 2] = x - B[i, 0], y - B[i, 1], z - B[i, 2]
        for c in range(3):
            total += M[i, c] * (G[i, c] - B[i, c])
    return total


@njit(cache=True, nogil=True)
def twist_quadratic(A: FloatArray, M: FloatArray, G: FloatArray, K: FloatArray, F: FloatArray) -> None:
    """Write the quadratic of the energy in small twists of the bones, residuals taken as constant.

    Parameters
    ----------
    A : (4 J, 4 J) float
        Second moments.
    M : (4 J, 3) float
        Bone matrices.
    G : (4 J, 3) float
        ``A M - B``.
    K : (J, J, 36) float
        Written: 6 x 6, turn and velocity of the point at the origin, for all pairs of bones.
    F : (J, 6) float
        Gradient, written.
    """
    J = len(M) // 4
    P, C = np.zeros((4, 3)), np.zeros((3, 3))
    K[:] = 0
    for k in range(J):
        F[k] = 0
        for i in range(4):
            u, g = M[4 * k + i], G[4 * k + i]
            F[k, 0] += u[1] * g[2] - u[2] * g[1]
            F[k, 1] += u[2] * g[0] - u[0] * g[2]
            F[k, 2] += u[0] * g[1] - u[1] * g[0]
        F[k, 3:] = G[4 * k + 3]
        for m in range(k + 1):
            if A[4 * k + 3, 4 * m + 3] == 0:
                continue
            _pair(A, M, k, m, P, C, K[k, m])
            if m < k:
                for a in range(6):
                    for b in range(6):
                        K[m, k, 6 * a + b] = K[k, m, 6 * b + a]


@njit(cache=True, nogil=True)
def _pair(
    A: FloatArray, M: FloatArray, k: int, m: int, P: FloatArray, C: FloatArray, out: FloatArray
) -> None:
    # (e_a x u) . (e_b x v) = (u . v) [a = b] - u_b v_a, summed over the rows u of bone k and v of bone m
    for i in range(4):
        for c in range(3):
            P[i, c] = 0.0
            for h in range(4):
                P[i, c] += A[4 * k + i, 4 * m + h] * M[4 * m + h, c]
    s0 = s1 = s2 = 0.0
    C[:] = 0
    for i in range(4):
        u, a = M[4 * k + i], A[4 * k + i, 4 * m + 3]
        s0, s1, s2 = s0 + a * u[0], s1 + a * u[1], s2 + a * u[2]
        for x in range(3):
            for y in range(3):
                C[x, y] += u[x] * P[i, y]
    trace = C[0, 0] + C[1, 1] + C[2, 2]
    t, shared = P[3], A[4 * k + 3, 4 * m + 3]
    for a in range(3):
        for b in range(3):
            out[6 * a + b] = -C[b, a]
        out[7 * a] += trace
        out[21 + 7 * a] = shared
    # [s] x above, -[t] x below
    out[4], out[5], out[11] = -s2, s1, -s0
    out[9], out[15], out[16] = s2, -s1, s0
    out[19], out[20], out[26] = t[2], -t[1], t[0]
    out[24], out[30], out[31] = -t[2], t[1], -t[0]


@njit(cache=True, nogil=True)
def add_curvature(
    M: FloatArray, G: FloatArray, q: FloatArray, parents: IntArray, H: FloatArray, out: FloatArray
) -> None:
    """Add to the Gauss-Newton matrix what residuals add to the true second derivatives.

    Parameters
    ----------
    M : (4 J, 3) float
        Bone matrices.
    G : (4 J, 3) float
        ``A M - B``.
    q : (J, 3) float
        Joints.
    parents : (J,) int
        Parents first.
    H : (3 J + 3, 3 J + 3) float
        Gauss-Newton matrix, lower triangle.
    out : (3 J + 3, 3 J + 3) float
        Lower triangle of the Hessian, written.

    Notes
    -----
    Under turns a of a joint and b of a joint m below it a point moves by ``a x (b x (x - q_l))`` to second
    order, so that only ``sum g (x - q_l)^T`` over the subtree of m is needed.
    """
    J = len(parents)
    S, f = np.zeros((J, 3, 3)), np.zeros((J, 3))
    out[:] = H
    for m in range(J - 1, -1, -1):
        f[m] += G[4 * m + 3]
        for i in range(4):
            for x in range(3):
                for y in range(3):
                    S[m, x, y] += G[4 * m + i, x] * M[4 * m + i, y]
        if m > 0:
            S[parents[m]] += S[m]
            f[parents[m]] += f[m]
        trace = 0.0
        for x in range(3):
            trace += S[m, x, x] - f[m, x] * q[m, x]
        j = m
        while j >= 0:
            for a in range(3):
                for b in range(3):
                    bent = S[m, b, a] - f[m, b] * q[m, a]
                    if j == m:
                        bent = 0.5 * (bent + S[m, a, b] - f[m, a] * q[m, b])
                    if a == b:
                        bent -= trace
                    out[3 * m + b, 3 * j + a] += bent
            j = parents[j]


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
