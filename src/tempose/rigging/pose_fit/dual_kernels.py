"""Error of a dual-quaternion skin and its gradient in twists of the bones, one frame."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True, nogil=True)
def dual_energy(
    starts: IntArray,
    joints: IntArray,
    weights: FloatArray,
    real: FloatArray,
    dual: FloatArray,
    V: FloatArray,
    Y: FloatArray,
    F: FloatArray,
) -> float:
    """Sum the squared distances of a posed skin from a frame.

    Parameters
    ----------
    starts, joints, weights : ndarray
        From `rows_by_strength`; vertices bound to nothing are left out.
    real, dual : (J, 4) float
        Unit dual quaternions of the bones.
    V, Y : (n, 3) float
        Bind pose and frame, metres.
    F : (J, 6) float
        Written: half the gradient, by the turn and the velocity of the point at the origin.

    Returns
    -------
    float
        Metres squared.

    Notes
    -----
    A twist t_k of bone k multiplies the blend b by ``1 + sum_k t_k c_k / 2``, ``c_k = w_k q_k b^-1``. So the
    gradient needs, a bone, the sum of ``w_k b^-1`` times the pulls of the vertices: eight numbers.
    """
    J = len(real)
    sums = np.zeros((J, 8))
    b, h, g, s = np.zeros(8), np.zeros(4), np.zeros(4), np.zeros(4)
    total = 0.0
    for v in range(len(V)):
        first, last = starts[v], starts[v + 1]
        if first == last:
            continue
        pivot = real[joints[first]]
        b[:] = 0
        for k in range(first, last):
            r, d, w = real[joints[k]], dual[joints[k]], weights[k]
            if r[0] * pivot[0] + r[1] * pivot[1] + r[2] * pivot[2] + r[3] * pivot[3] < 0:
                w = -w
            for i in range(4):
                b[i] += w * r[i]
                b[4 + i] += w * d[i]
        square = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3]
        w, x, y, z = b[0], b[1], b[2], b[3]
        X, Q, Z = V[v, 0], V[v, 1], V[v, 2]
        tx, ty, tz = 2 * (y * Z - z * Q), 2 * (z * X - x * Z), 2 * (x * Q - y * X)
        px = X + (w * tx + y * tz - z * ty + 2 * (w * b[5] - b[4] * x + y * b[7] - z * b[6])) / square
        py = Q + (w * ty + z * tx - x * tz + 2 * (w * b[6] - b[4] * y + z * b[5] - x * b[7])) / square
        pz = Z + (w * tz + x * ty - y * tx + 2 * (w * b[7] - b[4] * z + x * b[6] - y * b[5])) / square
        rx, ry, rz = px - Y[v, 0], py - Y[v, 1], pz - Y[v, 2]
        total += rx * rx + ry * ry + rz * rz
        # h = b^-1 (0, r); g = b^-1 (0, p x r) - b^-1 dual(b) h
        _left(w / square, -x / square, -y / square, -z / square, 0.0, rx, ry, rz, h)
        _left(b[4], b[5], b[6], b[7], h[0], h[1], h[2], h[3], s)
        mx, my, mz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
        _left(w / square, -x / square, -y / square, -z / square, -s[0], mx - s[1], my - s[2], mz - s[3], g)
        for k in range(first, last):
            j, c = joints[k], weights[k]
            r = real[j]
            if r[0] * pivot[0] + r[1] * pivot[1] + r[2] * pivot[2] + r[3] * pivot[3] < 0:
                c = -c
            for i in range(4):
                sums[j, i] += c * h[i]
                sums[j, 4 + i] += c * g[i]
    for j in range(J):
        r, d, u = real[j], dual[j], sums[j]
        _left(r[0], r[1], r[2], r[3], u[0], u[1], u[2], u[3], s)
        F[j, 3:] = s[1:]
        _left(r[0], r[1], r[2], r[3], u[4], u[5], u[6], u[7], s)
        _left(d[0], d[1], d[2], d[3], u[0], u[1], u[2], u[3], h)
        F[j, :3] = s[1:] + h[1:]
    return total


@njit(cache=True, nogil=True, inline="always")
def _left(
    a: float, b: float, c: float, d: float, w: float, x: float, y: float, z: float, out: FloatArray
) -> None:
    out[0] = a * w - b * x - c * y - d * z
    out[1] = a * x + b * w + c * z - d * y
    out[2] = a * y - b * z + c * w + d * x
    out[3] = a * z + b * y - c * x + d * w
