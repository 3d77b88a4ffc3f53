"""Loops of posing: a block of vertices at a time, the vertices of a block side by side.

Numbers stay in the type of the arrays: no literal may widen float32.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def skin_linear(
    starts: IntArray,
    joints: IntArray,
    W: FloatArray,
    M: FloatArray,
    X: FloatArray,
    P: FloatArray,
    Q: FloatArray,
) -> None:
    """Linear blend skinning, and the blended rotation of every vertex.

    Parameters
    ----------
    starts, joints, W : (b + 1,) int32, (c,) int32, (c, BLOCK) float
        Weights in blocks, columns in fours.
    M : (J, 16) float
        Of every joint the rotation from bind pose to posed by rows (9), the shift (3), and the rotation as
        a quaternion (4) whose sign agrees with that of its parent.
    X : (b, 3, BLOCK) float
        Vertices of the bind pose.
    P : (b, 3, BLOCK) float
        Filled with posed vertices.
    Q : (b, 4, BLOCK) float
        Filled with blended rotations wxyz; zero where nothing is bound.
    """
    width = W.shape[1]
    A = np.zeros((16, width), W.dtype)
    for b in range(len(starts) - 1):
        _blend(starts[b], starts[b + 1], joints, W, M, A)
        for v in range(width):
            x, y, z = X[b, 0, v], X[b, 1, v], X[b, 2, v]
            P[b, 0, v] = A[0, v] * x + A[1, v] * y + A[2, v] * z + A[9, v]
            P[b, 1, v] = A[3, v] * x + A[4, v] * y + A[5, v] * z + A[10, v]
            P[b, 2, v] = A[6, v] * x + A[7, v] * y + A[8, v] * z + A[11, v]
        _normalise(A, 12, Q[b])


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def skin_dual(
    starts: IntArray,
    joints: IntArray,
    W: FloatArray,
    M: FloatArray,
    X: FloatArray,
    P: FloatArray,
    Q: FloatArray,
) -> None:
    """Dual-quaternion skinning; arguments as of `skin_linear`.

    Parameters
    ----------
    starts, joints, W : (b + 1,) int32, (c,) int32, (c, BLOCK) float
        Weights in blocks, columns in fours.
    M : (J, 8) float
        Unit dual quaternion of every joint, real part then dual part, signs as of the parent.
    X : (b, 3, BLOCK) float
        Vertices of the bind pose.
    P : (b, 3, BLOCK) float
        Filled with posed vertices.
    Q : (b, 4, BLOCK) float
        Filled with blended rotations wxyz.
    """
    width = W.shape[1]
    A = np.zeros((8, width), W.dtype)
    for b in range(len(starts) - 1):
        _blend(starts[b], starts[b + 1], joints, W, M, A)
        for v in range(width):
            length = np.sqrt(A[0, v] * A[0, v] + A[1, v] * A[1, v] + A[2, v] * A[2, v] + A[3, v] * A[3, v])
            if length > 0:
                for c in range(4):
                    A[4 + c, v] /= length
        _normalise(A, 0, Q[b])
        for v in range(width):
            w, x, y, z = Q[b, 0, v], Q[b, 1, v], Q[b, 2, v], Q[b, 3, v]
            e, f, g, h = A[4, v], A[5, v], A[6, v], A[7, v]
            sx = w * f - e * x + y * h - z * g
            sy = w * g - e * y + z * f - x * h
            sz = w * h - e * z + x * g - y * f
            px, py, pz = _turn(w, x, y, z, X[b, 0, v], X[b, 1, v], X[b, 2, v])
            P[b, 0, v] = px + sx + sx
            P[b, 1, v] = py + sy + sy
            P[b, 2, v] = pz + sz + sz


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def add_detail(
    starts: IntArray,
    regions: IntArray,
    S: FloatArray,
    C: FloatArray,
    B: IntArray,
    Q: FloatArray,
    P: FloatArray,
) -> None:
    """Add to every vertex its mixture of modes, turned with it.

    Parameters
    ----------
    starts, regions, S : (b + 1,) int32, (c,) int32, (c, BLOCK) float
        Shares of regions in blocks, columns in fours.
    C : (R, K) float
        Coefficient of every mode in every region; K is a multiple of 4.
    B : (b, K, 3, BLOCK) int16
        Modes, in steps.
    Q : (b, 4, BLOCK) float
        Rotation of every vertex.
    P : (b, 3, BLOCK) float
        Posed vertices, moved.
    """
    width = S.shape[1]
    E = np.zeros((3, width), S.dtype)
    alpha = np.zeros((4, width), S.dtype)
    for b in range(len(starts) - 1):
        E[:] = 0
        for k in range(0, C.shape[1], 4):
            _blend(starts[b], starts[b + 1], regions, S, C[:, k : k + 4], alpha)
            for v in range(width):
                p, q, r, s = alpha[0, v], alpha[1, v], alpha[2, v], alpha[3, v]
                for a in range(3):
                    E[a, v] += (
                        p * B[b, k, a, v]
                        + q * B[b, k + 1, a, v]
                        + r * B[b, k + 2, a, v]
                        + s * B[b, k + 3, a, v]
                    )
        for v in range(width):
            x, y, z = _turn(Q[b, 0, v], Q[b, 1, v], Q[b, 2, v], Q[b, 3, v], E[0, v], E[1, v], E[2, v])
            P[b, 0, v] += x
            P[b, 1, v] += y
            P[b, 2, v] += z


@njit(cache=True)
def scatter(P: FloatArray, order: IntArray, shift: FloatArray, V: FloatArray) -> None:
    """Put the vertices of blocks where they belong.

    Parameters
    ----------
    P : (b, 3, BLOCK) float
        Vertices in blocks.
    order : (n,) int
        The vertex at each place.
    shift : (3,) float
        Added to every vertex.
    V : (n, 3) float
        Filled.
    """
    width = P.shape[2]
    x, y, z = shift[0], shift[1], shift[2]
    for b in range(len(P)):
        for v in range(min(width, len(order) - b * width)):
            o = order[b * width + v]
            V[o, 0], V[o, 1], V[o, 2] = P[b, 0, v] + x, P[b, 1, v] + y, P[b, 2, v] + z


@njit(cache=True)
def pull_back(
    V: FloatArray, P: FloatArray, Q: FloatArray, order: IntArray, shift: FloatArray, D: FloatArray
) -> None:
    """Residuals of a frame in the rotations of its vertices.

    Parameters
    ----------
    V : (n, 3) float
        True frame.
    P, Q : (b, 3, BLOCK), (b, 4, BLOCK) float
        Posed vertices and rotations.
    order : (n,) int
        The vertex at each place.
    shift : (3,) float
        To be added to `P`.
    D : (n, 3) float
        Filled.
    """
    width = P.shape[2]
    for place in range(len(order)):
        b = place // width
        v = place - b * width
        o = order[place]
        x, y, z = _turn(
            Q[b, 0, v],
            -Q[b, 1, v],
            -Q[b, 2, v],
            -Q[b, 3, v],
            V[o, 0] - (P[b, 0, v] + shift[0]),
            V[o, 1] - (P[b, 1, v] + shift[1]),
            V[o, 2] - (P[b, 2, v] + shift[2]),
        )
        D[o, 0], D[o, 1], D[o, 2] = x, y, z


@njit(cache=True, inline="always")
def _turn(w: float, x: float, y: float, z: float, a: float, b: float, c: float) -> tuple[float, float, float]:
    """Rotate (a, b, c) by a unit quaternion; a quaternion of zero turns nothing."""
    p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
    p, q, r = p + p, q + q, r + r
    return a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def _blend(first: int, last: int, columns: IntArray, W: FloatArray, M: FloatArray, A: FloatArray) -> None:
    """Blend rows of M by the weights of a block, four at a time: sums are read and written less often."""
    for i in range(first, last, 4):
        e, f, g, h = columns[i], columns[i + 1], columns[i + 2], columns[i + 3]
        for c in range(len(A)):
            p, q, r, s = M[e, c], M[f, c], M[g, c], M[h, c]
            if i == first:
                for v in range(A.shape[1]):
                    A[c, v] = p * W[i, v] + q * W[i + 1, v] + r * W[i + 2, v] + s * W[i + 3, v]
            else:
                for v in range(A.shape[1]):
                    A[c, v] += p * W[i, v] + q * W[i + 1, v] + r * W[i + 2, v] + s * W[i + 3, v]


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def _normalise(A: FloatArray, first: int, Q: FloatArray) -> None:
    for v in range(A.shape[1]):
        w, x, y, z = A[first, v], A[first + 1, v], A[first + 2, v], A[first + 3, v]
        length = np.sqrt(w * w + x * x + y * y + z * z)
        if length > 0:
            w, x, y, z = w / length, x / length, y / length, z / length
        Q[0, v], Q[1, v], Q[2, v], Q[3, v] = w, x, y, z
