"""Small steps of every joint: how twists of bones become steps of a tree, and the linear system solved."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.rigging.pose_fit.matrix_kernels import product, rotation
from tempose.typing import FloatArray, IntArray


@njit(cache=True, nogil=True)
def place(R: FloatArray, root: FloatArray, parents: IntArray, steps: FloatArray, q: FloatArray) -> None:
    """Put joints where the turns of the bones above bring them.

    Parameters
    ----------
    R : (J, 3, 3) float
        Turn of every bone from the bind pose to the world.
    root : (3,) float
        Position of joint 0.
    parents : (J,) int
        Parents first.
    steps : (J, 3) float
        From the parent to the joint in the bind pose, world axes, metres.
    q : (J, 3) float
        Positions, written.
    """
    q[0] = root
    for j in range(1, len(parents)):
        a = parents[j]
        for c in range(3):
            q[j, c] = q[a, c] + R[a, c, 0] * steps[j, 0] + R[a, c, 1] * steps[j, 1] + R[a, c, 2] * steps[j, 2]


@njit(cache=True, nogil=True)
def normal_equations(
    K: FloatArray, F: FloatArray, q: FloatArray, parents: IntArray, H: FloatArray, g: FloatArray
) -> None:
    """Bring a quadratic in twists of bones to steps of joints.

    Parameters
    ----------
    K : (J, J, 36) float
        Quadratic in the twists (turn, then velocity of the point at the origin) of all pairs of bones, 6 x 6;
        overwritten by sums over subtrees.
    F : (J, 6) float
        Gradient by the twists; overwritten likewise.
    q : (J, 3) float
        Joints.
    parents : (J,) int
        Parents first.
    H : (3 J + 3, 3 J + 3) float
        Lower triangle written; three turns a joint, which carry all below it, then the root's translation.
    g : (3 J + 3,) float
        Gradient, written.
    """
    J = len(parents)
    for j in range(J - 1, 0, -1):
        a = parents[j]
        for c in range(6):
            F[a, c] += F[j, c]
        for m in range(J):
            for c in range(36):
                K[a, m, c] += K[j, m, c]
    for j in range(J):
        for m in range(J - 1, 0, -1):
            a = parents[m]
            for c in range(36):
                K[j, a, c] += K[j, m, c]
    half = np.zeros(18)
    for j in range(J + 1):
        own = min(j, J) % J
        for m in range(j + 1):
            other = m % J
            block = K[own, other]
            if j == J:
                half[:] = block[18:]
            else:
                _turned_rows(block, q[own, 0], q[own, 1], q[own, 2], half)
            px, py, pz = q[other, 0], q[other, 1], q[other, 2]
            for a in range(3):
                u, v, w = half[6 * a], half[6 * a + 1], half[6 * a + 2]
                x, y, z = half[6 * a + 3], half[6 * a + 4], half[6 * a + 5]
                if m < J:
                    # velocity of the origin under a turn w about q is q x w
                    x, y, z = u + y * pz - z * py, v + z * px - x * pz, w + x * py - y * px
                H[3 * j + a, 3 * m], H[3 * j + a, 3 * m + 1], H[3 * j + a, 3 * m + 2] = x, y, z
    for j in range(J):
        x, y, z = F[j, 3], F[j, 4], F[j, 5]
        g[3 * j] = F[j, 0] + y * q[j, 2] - z * q[j, 1]
        g[3 * j + 1] = F[j, 1] + z * q[j, 0] - x * q[j, 2]
        g[3 * j + 2] = F[j, 2] + x * q[j, 1] - y * q[j, 0]
    g[3 * J :] = F[0, 3:]


@njit(cache=True, nogil=True)
def _turned_rows(K: FloatArray, px: float, py: float, pz: float, half: FloatArray) -> None:
    for c in range(6):
        x, y, z = K[18 + c], K[24 + c], K[30 + c]
        half[c] = K[c] + y * pz - z * py
        half[6 + c] = K[6 + c] + z * px - x * pz
        half[12 + c] = K[12 + c] + x * py - y * px


@njit(cache=True, nogil=True, fastmath=True)
def damped_step(H: FloatArray, g: FloatArray, damping: float, L: FloatArray, step: FloatArray) -> float:
    """Solve ``(H + damping diag H) step = -g`` by Cholesky.

    Parameters
    ----------
    H : (N, N) float
        Symmetric; lower triangle read; the last three are the root's translation.
    g : (N,) float
        Gradient.
    damping : float
        Levenberg-Marquardt damping, relative to the diagonal.
    L : (N, N) float
        Room for the factor.
    step : (N,) float
        Written.

    Returns
    -------
    float
        Twice the fall of the quadratic along the step; -1 if `H` is not positive, and no step then.
    """
    N = len(g)
    mean = 0.0
    for i in range(N - 3):
        mean += H[i, i] / (N - 3)
    for i in range(N):
        # turns and the translation have different units
        least = mean if i < N - 3 else H[i, i]
        for j in range(i + 1):
            total = H[i, j]
            if i == j:
                total += damping * H[i, i] + 1e-10 * least
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j:
                if total < 1e-13 * least:
                    return -1.0
                L[i, i] = np.sqrt(total)
            else:
                L[i, j] = total / L[j, j]
    for i in range(N):
        total = -g[i]
        for k in range(i):
            total -= L[i, k] * step[k]
        step[i] = total / L[i, i]
    fall = 0.0
    for i in range(N):
        fall += step[i] * step[i]
    for i in range(N - 1, -1, -1):
        total = step[i]
        for k in range(i + 1, N):
            total -= L[k, i] * step[k]
        step[i] = total / L[i, i]
    return fall


@njit(cache=True, nogil=True)
def turn_joints(step: FloatArray, parents: IntArray, R: FloatArray, out: FloatArray) -> None:
    """Turn every bone by the steps of its joint and of all joints above.

    Parameters
    ----------
    step : (3 J + 3,) float
        Rotation vectors in the world, radians, then the root's translation (not used here).
    parents : (J,) int
        Parents first.
    R : (J, 3, 3) float
        Turns of the bones.
    out : (J, 3, 3) float
        New turns, written; not `R` itself.
    """
    J = len(parents)
    total = np.zeros((J, 3, 3))
    E = np.zeros((3, 3))
    for j in range(J):
        rotation(step[3 * j : 3 * j + 3], E)
        if j == 0:
            total[0] = E
        else:
            product(total[parents[j]], E, total[j])
        product(total[j], R[j], out[j])
