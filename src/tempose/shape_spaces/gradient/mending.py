"""Rotations of faces that the fast kernels leave over."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np


@numba.njit(cache=True, nogil=True)
def mend_axes(P: Any, N: Any, out: Any) -> None:
    """Choose the rotation of a face without area, as near to the reference as its edges allow.

    Parameters
    ----------
    P : (6,) ndarray
        Images of the axes, parallel or zero.
    N : (9,) ndarray
        Reference frame, axis after axis.
    out : (13,) ndarray
        Written: the axes of a rotation R and entries xx, yy, zz and xy of a stretch S, ``R S`` the images.
    """
    pp, qq = P[0] ** 2 + P[1] ** 2 + P[2] ** 2, P[3] ** 2 + P[4] ** 2 + P[5] ** 2
    if not pp + qq > 0.0:
        out[:9] = N[:9]
        out[9:13] = 0.0
        return
    # all lies along one direction e: p = a e, q = b e
    e = (P[0:3] if pp >= qq else P[3:6]) / math.sqrt(max(pp, qq))
    a, b = _dot(P[0:3], e), _dot(P[3:6], e)
    length = math.sqrt(a * a + b * b)
    a, b = a / length, b / length
    n = N[6:9] - _dot(N[6:9], e) * e
    if _dot(n, n) < 1e-12:
        # the reference normal itself lies along e: a reference axis across it instead
        n = N[3:6] - _dot(N[3:6], e) * e
    n /= math.sqrt(_dot(n, n))
    across = np.cross(n, e)
    # R takes (a, b) at rest to e and (-b, a) to the direction across
    out[0:3], out[3:6], out[6:9] = a * e - b * across, b * e + a * across, n
    out[9], out[10], out[11], out[12] = length * a * a, length * b * b, 0.0, length * a * b


@numba.njit(cache=True, nogil=True)
def _dot(x: Any, y: Any) -> Any:
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@numba.njit(cache=True, nogil=True)
def log_far(R: Any, N: Any, w: Any) -> None:
    """Rotation vector between two frames, well conditioned up to half a turn.

    Parameters
    ----------
    R, N : (9,) ndarray
        Frame and reference frame, axis after axis.
    w : (3,) ndarray
        Written.
    """
    Q = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            Q[i, j] = N[3 * i] * R[3 * j] + N[3 * i + 1] * R[3 * j + 1] + N[3 * i + 2] * R[3 * j + 2]
    i = 0
    if Q[1, 1] > Q[0, 0]:
        i = 1
    if Q[2, 2] > Q[i, i]:
        i = 2
    j, k = (i + 1) % 3, (i + 2) % 3
    # the quaternion by the largest component of its axis
    big = math.sqrt(max(1.0 + Q[i, i] - Q[j, j] - Q[k, k], 0.0))
    scalar = (Q[k, j] - Q[j, k]) / big
    v = np.zeros(3)
    v[i], v[j], v[k] = big, (Q[j, i] + Q[i, j]) / big, (Q[k, i] + Q[i, k]) / big
    if scalar < 0.0:
        scalar, v = -scalar, -v
    length = math.sqrt(_dot(v, v))
    w[:3] = 2.0 * math.atan2(length, scalar) / length * v
