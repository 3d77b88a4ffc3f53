"""The rotation nearest to a 3 x 3 matrix, without LAPACK: for loops that need many of them."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray

_SWEEPS = 12


@njit(cache=True, nogil=True)
def nearest_rotation(N: FloatArray, R: FloatArray) -> None:
    """Write the rotation R that maximises ``trace(R^T N)``.

    Parameters
    ----------
    N : (3, 3) float
        Sum of outer products ``y x^T`` of targets and what is turned onto them; zero gives the identity.
    R : (3, 3) float
        Rotation, determinant +1, written.

    Notes
    -----
    Its quaternion is the top eigenvector of Horn's symmetric 4 x 4 matrix [1]_, found by Jacobi rotations.

    References
    ----------
    .. [1] Horn, "Closed-form solution of absolute orientation using unit quaternions", JOSA A 4, 1987.
    """
    S, E = np.zeros((4, 4)), np.eye(4)
    S[0, 0] = N[0, 0] + N[1, 1] + N[2, 2]
    S[0, 1] = S[1, 0] = N[2, 1] - N[1, 2]
    S[0, 2] = S[2, 0] = N[0, 2] - N[2, 0]
    S[0, 3] = S[3, 0] = N[1, 0] - N[0, 1]
    S[1, 1] = N[0, 0] - N[1, 1] - N[2, 2]
    S[2, 2] = N[1, 1] - N[0, 0] - N[2, 2]
    S[3, 3] = N[2, 2] - N[0, 0] - N[1, 1]
    S[1, 2] = S[2, 1] = N[0, 1] + N[1, 0]
    S[1, 3] = S[3, 1] = N[0, 2] + N[2, 0]
    S[2, 3] = S[3, 2] = N[1, 2] + N[2, 1]
    _diagonalise(S, E)
    best = 0
    for k in range(1, 4):
        if S[k, k] > S[best, best]:
            best = k
    w, x, y, z = E[0, best], E[1, best], E[2, best], E[3, best]
    R[0, 0], R[0, 1], R[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    R[1, 0], R[1, 1], R[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    R[2, 0], R[2, 1], R[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@njit(cache=True, nogil=True)
def _diagonalise(S: FloatArray, E: FloatArray) -> None:
    size = 0.0
    for i in range(4):
        for j in range(4):
            size += S[i, j] * S[i, j]
    for _ in range(_SWEEPS):
        left = 0.0
        for i in range(4):
            for j in range(i):
                left += S[i, j] * S[i, j]
        if left <= 1e-30 * size:
            return
        for i in range(1, 4):
            for j in range(i):
                if S[i, j] != 0.0:
                    _rotate_pair(S, E, i, j)


@njit(cache=True, nogil=True)
def _rotate_pair(S: FloatArray, E: FloatArray, i: int, j: int) -> None:
    theta = (S[j, j] - S[i, i]) / (2.0 * S[i, j])
    t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
    if theta < 0:
        t = -t
    c = 1.0 / np.sqrt(t * t + 1.0)
    s = t * c
    for k in range(4):
        a, b = S[k, i], S[k, j]
        S[k, i], S[k, j] = c * a - s * b, s * a + c * b
    for k in range(4):
        a, b = S[i, k], S[j, k]
        S[i, k], S[j, k] = c * a - s * b, s * a + c * b
        a, b = E[k, i], E[k, j]
        E[k, i], E[k, j] = c * a - s * b, s * a + c * b
