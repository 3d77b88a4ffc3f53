"""Products, exponentials and rounding of 3 x 3 matrices inside compiled loops."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray


@njit(cache=True, nogil=True)
def product(A: FloatArray, B: FloatArray, out: FloatArray) -> None:
    """Multiply 3 x 3 matrices.

    Parameters
    ----------
    A, B : (3, 3) float
        Factors.
    out : (3, 3) float
        Product, written.
    """
    for a in range(3):
        for b in range(3):
            out[a, b] = A[a, 0] * B[0, b] + A[a, 1] * B[1, b] + A[a, 2] * B[2, b]


@njit(cache=True, nogil=True)
def rotation(w: FloatArray, E: FloatArray) -> None:
    """Write the matrix of a rotation vector (Rodrigues).

    Parameters
    ----------
    w : (3,) float
        Rotation vector, radians.
    E : (3, 3) float
        Rotation matrix, written.
    """
    x, y, z = w[0], w[1], w[2]
    square = x * x + y * y + z * z
    angle = np.sqrt(square)
    if angle > 1e-4:
        a, b = np.sin(angle) / angle, (1 - np.cos(angle)) / square
    else:
        a, b = 1 - square / 6, 0.5 - square / 24
    E[0, 0], E[0, 1], E[0, 2] = 1 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    E[1, 0], E[1, 1], E[1, 2] = b * x * y + a * z, 1 - b * (x * x + z * z), b * y * z - a * x
    E[2, 0], E[2, 1], E[2, 2] = b * x * z - a * y, b * y * z + a * x, 1 - b * (x * x + y * y)


@njit(cache=True, nogil=True)
def orthonormalise(R: FloatArray) -> None:
    """Take rounding out of rotation matrices, which long products pile up (Gram-Schmidt by rows).

    Parameters
    ----------
    R : (J, 3, 3) float
        Almost rotations, overwritten.
    """
    for j in range(len(R)):
        a, b, c = R[j, 0], R[j, 1], R[j, 2]
        a /= np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        b -= (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * a
        b /= np.sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
        c[0], c[1], c[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
