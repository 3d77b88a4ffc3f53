"""What a frame spends its time in beside the solve: spread rotations, turn faces, write vertices.

Rows belong to the unknowns in the order of the factor; a last row of zeros stands for nothing. One frame has
rows ``(x, y, z, w)`` and ``(x, y, z, 0)``, vectorised within a row; K frames have rows of 4 K and of 3 K
numbers, frames innermost, vectorised across frames.
"""

from __future__ import annotations

from typing import Any

import numba

from tempose.linalg.lanes import alike, item, lane, load4, load8, plus_times, scaled, store, turned

TILE = 64


@numba.njit(cache=True, nogil=True)
def spread_1(W: Any, Q: Any, B: Any, q: Any) -> None:
    """Blend the rotations of one frame at every row, ``q = W Q``.

    Parameters
    ----------
    W : (n B,) ndarray
        Harmonic weights, row by row.
    Q : (4 B,) ndarray
        Rotations, xyzw.
    B : int
        Number of rotations.
    q : (4 n,) ndarray
        Written.
    """
    for v in range(len(W) // B):
        at = v * B
        y = scaled(item(W, at), load4(Q, 0))
        for b in range(1, B):
            y = plus_times(y, item(W, at + b), load4(Q, 4 * b))
        store(q, 4 * v, y)


@numba.njit(cache=True, nogil=True)
def spread_8(W: Any, Q: Any, B: Any, k: Any, q: Any) -> None:
    """Blend the rotations of several frames at every row.

    Parameters
    ----------
    W : (n B,) ndarray
        Harmonic weights, row by row.
    Q : (B k,) ndarray
        Rows of components wxyz of the frames.
    B, k : int
        Number of rotations and of components in all, a multiple of 32.
    q : (n k,) ndarray
        Written.
    """
    for v in range(len(W) // B):
        at = v * B
        for c in range(0, k, 32):
            y0, y1 = scaled(item(W, at), load8(Q, c)), scaled(item(W, at), load8(Q, c + 8))
            y2, y3 = scaled(item(W, at), load8(Q, c + 16)), scaled(item(W, at), load8(Q, c + 24))
            for b in range(1, B):
                w, p = item(W, at + b), b * k + c
                y0 = plus_times(y0, w, load8(Q, p))
                y1 = plus_times(y1, w, load8(Q, p + 8))
                y2 = plus_times(y2, w, load8(Q, p + 16))
                y3 = plus_times(y3, w, load8(Q, p + 24))
            store(q, v * k + c, y0)
            store(q, v * k + c + 8, y1)
            store(q, v * k + c + 16, y2)
            store(q, v * k + c + 24, y3)


@numba.njit(cache=True, nogil=True, inline="always")
def _turn(p: Any, s: Any, d: Any) -> Any:
    """``R d - d`` for the quaternion p, s = 2 / |p|^2: no square root, and exactly zero for the identity."""
    after = turned(p)
    t = scaled(s, turned(p * turned(d) - after * d))
    return plus_times(turned(p * turned(t) - after * t), lane(p, 3), t)


@numba.njit(cache=True, nogil=True, error_model="numpy")
def add_faces_1(q: Any, F: Any, D: Any, u: Any) -> None:
    """Add what turning the faces changes in their Laplacian coordinates, eqs. (3)-(4).

    Parameters
    ----------
    q : (4 (n + 1),) ndarray
        Quaternion field, xyzw, not normalised.
    F : (m, 3) int ndarray
        Rows of the corners; the spare row as third corner makes an edge of a face.
    D : (8 m,) ndarray
        Laplacian coordinates at rest of the first two corners of each face in itself, each (x, y, z, 0);
        those of a face sum to zero.
    u : (4 (n + 1),) ndarray
        Added to.
    """
    two, tiny = q.dtype.type(2.0), q.dtype.type(1e-30)
    for f in range(F.shape[0]):
        i, j, k = 4 * F[f, 0], 4 * F[f, 1], 4 * F[f, 2]
        p = load4(q, i) + load4(q, j) + load4(q, k)
        n = p * p
        s = two / (lane(n, 0) + lane(n, 1) + lane(n, 2) + lane(n, 3) + tiny)
        a, b = _turn(p, s, load4(D, 8 * f)), _turn(p, s, load4(D, 8 * f + 4))
        store(u, i, load4(u, i) + a)
        store(u, j, load4(u, j) + b)
        store(u, k, load4(u, k) - (a + b))


@numba.njit(cache=True, nogil=True, inline="always")
def _turn_8(w: Any, x: Any, y: Any, z: Any, s: Any, D: Any, at: Any) -> Any:
    a, b, c = alike(w, item(D, at)), alike(w, item(D, at + 1)), alike(w, item(D, at + 2))
    t0, t1, t2 = s * (y * c - z * b), s * (z * a - x * c), s * (x * b - y * a)
    return w * t0 + y * t2 - z * t1, w * t1 + z * t0 - x * t2, w * t2 + x * t1 - y * t0


@numba.njit(cache=True, nogil=True)
def add_faces_8(q: Any, F: Any, D: Any, K: Any, u: Any) -> None:
    """Add as `add_faces_1` for K frames.

    Parameters
    ----------
    q : (4 K (n + 1),) ndarray
        Quaternion fields: a row has w of all frames, then x, y, z.
    F : (m, 3) int ndarray
        Rows of the corners.
    D : (8 m,) ndarray
        Coordinates at rest.
    K : int
        Number of frames, a multiple of 8.
    u : (3 K (n + 1),) ndarray
        Added to.
    """
    two, tiny = q.dtype.type(2.0), q.dtype.type(1e-30)
    for f in range(F.shape[0]):
        i, j, k = F[f, 0], F[f, 1], F[f, 2]
        for t in range(0, K, 8):
            qi, qj, qk = 4 * K * i + t, 4 * K * j + t, 4 * K * k + t
            w = load8(q, qi) + load8(q, qj) + load8(q, qk)
            x = load8(q, qi + K) + load8(q, qj + K) + load8(q, qk + K)
            y = load8(q, qi + 2 * K) + load8(q, qj + 2 * K) + load8(q, qk + 2 * K)
            z = load8(q, qi + 3 * K) + load8(q, qj + 3 * K) + load8(q, qk + 3 * K)
            s = alike(w, two) / (w * w + x * x + (y * y + z * z) + alike(w, tiny))
            a0, a1, a2 = _turn_8(w, x, y, z, s, D, 8 * f)
            b0, b1, b2 = _turn_8(w, x, y, z, s, D, 8 * f + 4)
            ui, uj, uk = 3 * K * i + t, 3 * K * j + t, 3 * K * k + t
            store(u, ui, load8(u, ui) + a0)
            store(u, ui + K, load8(u, ui + K) + a1)
            store(u, ui + 2 * K, load8(u, ui + 2 * K) + a2)
            store(u, uj, load8(u, uj) + b0)
            store(u, uj + K, load8(u, uj + K) + b1)
            store(u, uj + 2 * K, load8(u, uj + 2 * K) + b2)
            store(u, uk, load8(u, uk) - (a0 + b0))
            store(u, uk + K, load8(u, uk + K) - (a1 + b1))
            store(u, uk + 2 * K, load8(u, uk + 2 * K) - (a2 + b2))


@numba.njit(cache=True, nogil=True)
def write_frames(
    u: Any, wide: Any, step: Any, rows: Any, rest: Any, R: Any, weights: Any, to: Any, out: Any
) -> None:
    """Turn displacements into vertices and put every frame in its place.

    Parameters
    ----------
    u : (wide (n + 1),) ndarray
        Displacements from the rest.
    wide, step : int
        Numbers a row, and from one component to the next.
    rows : (n',) int ndarray
        Row of each vertex.
    rest : (n', 3) ndarray
        Vertices at rest.
    R : (K, 3, 3) ndarray
        Rotation of the whole frame.
    weights : (n',) ndarray
        Share of each vertex in the anchor.
    to : (K, 3) ndarray
        Where the weighted mean of the vertices goes.
    out : (K, n', 3) ndarray
        Written.
    """
    K, n = out.shape[0], len(rows)
    for v in range(n):
        if weights[v] != 0.0:
            for t in range(K):
                for d in range(3):
                    share = weights[v] * (rest[v, d] + item(u, wide * rows[v] + t + d * step))
                    for c in range(3):
                        to[t, c] -= R[t, c, d] * share
    # some vertices at a time: their rows stay in the cache while the frames are written one by one
    for begin in range(0, n, TILE):
        for t in range(K):
            r00, r01, r02, sx = R[t, 0, 0], R[t, 0, 1], R[t, 0, 2], to[t, 0]
            r10, r11, r12, sy = R[t, 1, 0], R[t, 1, 1], R[t, 1, 2], to[t, 1]
            r20, r21, r22, sz = R[t, 2, 0], R[t, 2, 1], R[t, 2, 2], to[t, 2]
            for v in range(begin, min(begin + TILE, n)):
                at = wide * rows[v] + t
                x = rest[v, 0] + item(u, at)
                y = rest[v, 1] + item(u, at + step)
                z = rest[v, 2] + item(u, at + 2 * step)
                out[t, v, 0] = r00 * x + r01 * y + r02 * z + sx
                out[t, v, 1] = r10 * x + r11 * y + r12 * z + sy
                out[t, v, 2] = r20 * x + r21 * y + r22 * z + sz
