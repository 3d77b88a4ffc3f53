"""Energy of a linear blend skin from moments, and its derivatives; no vertex is touched."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


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
