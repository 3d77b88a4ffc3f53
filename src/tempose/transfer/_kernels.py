"""The two loops that a frame spends its time in, vectorised across frames."""

from __future__ import annotations

from typing import Any

import numba


@numba.njit(cache=True, nogil=True, inline="always")
def _rotate(w: Any, x: Any, y: Any, z: Any, s: Any, a: Any, b: Any, c: Any) -> Any:
    # s = 2 / |q|^2 turns the unnormalised quaternion into a rotation without a square root
    tx = s * (y * c - z * b)
    ty = s * (z * a - x * c)
    tz = s * (x * b - y * a)
    return a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx


@numba.njit(cache=True, nogil=True, error_model="numpy")
def add_face_fragments(q: Any, F: Any, edges: Any, weights: Any, rhs: Any) -> None:
    """Add the Laplacian coordinates of the turned faces, eqs. (3)-(4), to the right-hand side.

    Parameters
    ----------
    q : (n, 4, K) ndarray
        Quaternion field of K frames at the vertices, not normalised.
    F : (m, 3) int ndarray
        Faces.
    edges : (m, 2, 3) ndarray
        Rest vectors ``v_j - v_i`` and ``v_k - v_j`` of each face ``(i, j, k)``.
    weights : (m, 3) ndarray
        Half cotangents at the corners.
    rhs : (n, 3, K) ndarray
        Added to in place.
    """
    K = q.shape[2]
    for f in range(F.shape[0]):
        i, j, k = F[f, 0], F[f, 1], F[f, 2]
        wi, wj, wk = weights[f, 0], weights[f, 1], weights[f, 2]
        for t in range(K):
            w = q[i, 0, t] + q[j, 0, t] + q[k, 0, t]
            x = q[i, 1, t] + q[j, 1, t] + q[k, 1, t]
            y = q[i, 2, t] + q[j, 2, t] + q[k, 2, t]
            z = q[i, 3, t] + q[j, 3, t] + q[k, 3, t]
            s = 2.0 / max(w * w + x * x + y * y + z * z, 1e-30)
            ax, ay, az = _rotate(w, x, y, z, s, edges[f, 0, 0], edges[f, 0, 1], edges[f, 0, 2])
            bx, by, bz = _rotate(w, x, y, z, s, edges[f, 1, 0], edges[f, 1, 1], edges[f, 1, 2])
            # edge ij weighs wk, jk weighs wi, ki weighs wj; the third turned edge is -(a + b)
            rhs[i, 0, t] -= wk * ax + wj * (ax + bx)
            rhs[i, 1, t] -= wk * ay + wj * (ay + by)
            rhs[i, 2, t] -= wk * az + wj * (az + bz)
            rhs[j, 0, t] += wk * ax - wi * bx
            rhs[j, 1, t] += wk * ay - wi * by
            rhs[j, 2, t] += wk * az - wi * bz
            rhs[k, 0, t] += wi * bx + wj * (ax + bx)
            rhs[k, 1, t] += wi * by + wj * (ay + by)
            rhs[k, 2, t] += wi * bz + wj * (az + bz)


@numba.njit(cache=True, nogil=True, error_model="numpy")
def add_edge_fragments(q: Any, pairs: Any, vectors: Any, weights: Any, rhs: Any) -> None:
    """Add extra edges (links between pieces, inner edges), each turned by the mean of its ends.

    Parameters
    ----------
    q : (n, 4, K) ndarray
        Quaternion field of K frames at the vertices, not normalised.
    pairs : (e, 2) int ndarray
        Vertex pairs (i, j).
    vectors : (e, 3) ndarray
        Rest vectors ``v_i - v_j``.
    weights : (e,) ndarray
        Weights of the edges in the Poisson matrix.
    rhs : (n, 3, K) ndarray
        Added to in place.
    """
    for e in range(pairs.shape[0]):
        i, j = pairs[e, 0], pairs[e, 1]
        for t in range(q.shape[2]):
            w = q[i, 0, t] + q[j, 0, t]
            x = q[i, 1, t] + q[j, 1, t]
            y = q[i, 2, t] + q[j, 2, t]
            z = q[i, 3, t] + q[j, 3, t]
            s = 2.0 / max(w * w + x * x + y * y + z * z, 1e-30)
            ax, ay, az = _rotate(w, x, y, z, s, vectors[e, 0], vectors[e, 1], vectors[e, 2])
            rhs[i, 0, t] += weights[e] * ax
            rhs[i, 1, t] += weights[e] * ay
            rhs[i, 2, t] += weights[e] * az
            rhs[j, 0, t] -= weights[e] * ax
            rhs[j, 1, t] -= weights[e] * ay
            rhs[j, 2, t] -= weights[e] * az
