"""Flatten a disc with little distortion, and never onto itself.

As rigid as possible, after Liu et al. [1]_; where that folds over, the barycentric map of Tutte [2]_ onto a
circle, which never does.

References
----------
.. [1] Liu et al., "A Local/Global Approach to Mesh Parameterization", SGP 2008.
.. [2] Tutte, "How to Draw a Graph", Proceedings of the London Mathematical Society, 1963.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from tempose.geometry import cotangents, edge_laplacian, edge_list, face_normals
from tempose.linalg import SparseCholesky, harmonic_extension
from tempose.typing import FloatArray, IntArray

ROUNDS = 40
"""Rounds of the local/global iteration."""


def flatten_rigidly(V: FloatArray, F: IntArray) -> FloatArray | None:
    """Map a disc to the plane with little distortion.

    Parameters
    ----------
    V, F : (n, 3) float, (m, 3) int
        A mesh that is topologically a disc, every vertex in use.

    Returns
    -------
    (n, 2) ndarray or None
        Texture coordinates in the unit of `V`, every triangle counter-clockwise, no two overlapping; None
        where that did not come about.
    """
    front = face_normals(V, F).mean(axis=0)
    if np.linalg.norm(front) < 1e-3:
        return None
    uv = _rigid(V, F, _seen_from(V, front / np.linalg.norm(front)))
    fine = (signed_areas(uv, F) > 0.0).all() and is_simple(uv[boundary_loop(F)])
    return uv if fine else None


def flatten_safely(V: FloatArray, F: IntArray) -> FloatArray:
    """Map a disc onto a circle: every vertex in the middle of its neighbours, which never folds over.

    Parameters
    ----------
    V, F : (n, 3) float, (m, 3) int
        A mesh that is topologically a disc, every vertex in use.

    Returns
    -------
    (n, 2) ndarray
        Texture coordinates, the rim as long as in `V`.
    """
    rim = boundary_loop(F)
    steps = np.linalg.norm(V[np.roll(rim, -1)] - V[rim], axis=1)
    angle = 2.0 * np.pi * (np.cumsum(steps) - steps) / steps.sum()
    circle = np.column_stack([np.cos(angle), np.sin(angle)]) * steps.sum() / (2.0 * np.pi)
    edges = edge_list(F)
    return harmonic_extension(edge_laplacian(edges, np.ones(len(edges)), len(V)), rim, circle)


def signed_areas(uv: FloatArray, F: IntArray) -> FloatArray:
    """Areas of triangles in the plane.

    Parameters
    ----------
    uv : (n, 2) float
        Points.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (m,) ndarray
        Positive where counter-clockwise.
    """
    a, b = uv[F[:, 1]] - uv[F[:, 0]], uv[F[:, 2]] - uv[F[:, 0]]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def boundary_loop(F: IntArray) -> IntArray:
    """Vertices along the rim of a disc.

    Parameters
    ----------
    F : (m, 3) int
        Faces with one simple boundary.

    Returns
    -------
    (b,) ndarray of int
        In order, the surface on the left.
    """
    a, b = F.ravel(), np.roll(F, -1, axis=1).ravel()
    n = int(F.max()) + 1
    forward, backward = a.astype(np.int64) * n + b, b.astype(np.int64) * n + a
    rim = ~np.isin(forward, backward)
    follow = dict(zip(a[rim].tolist(), b[rim].tolist()))
    loop = [int(a[rim].min())]
    while follow[loop[-1]] != loop[0]:
        loop.append(follow[loop[-1]])
    return np.array(loop)


def is_simple(P: FloatArray) -> bool:
    """Whether a closed polygon crosses itself nowhere.

    Parameters
    ----------
    P : (b, 2) float
        Corners in order.

    Returns
    -------
    bool
        True if no two of its sides cross.
    """
    Q = np.roll(P, -1, axis=0)
    for i in range(len(P) - 1):
        a, b, c, d = P[i], Q[i], P[i + 1 :], Q[i + 1 :]
        apart = (_turn(a, b, c) * _turn(a, b, d) >= 0) | (_turn(c, d, a) * _turn(c, d, b) >= 0)
        if not apart.all():
            return False
    return True


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    u, v = b - a, c - a
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _seen_from(V: FloatArray, front: FloatArray) -> FloatArray:
    """Project along a direction, so that what faces it is counter-clockwise."""
    across = np.cross((0.0, 1.0, 0.0) if abs(front[1]) < 0.9 else (0.0, 0.0, -1.0), front)
    across /= np.linalg.norm(across)
    return np.column_stack([V @ across, V @ np.cross(front, across)])


def _rigid(V: FloatArray, F: IntArray, uv: FloatArray) -> FloatArray:
    """Alternate between a rotation for every triangle and one linear system for all."""
    n = len(V)
    weights = np.maximum(cotangents(V, F), 0.02)
    flat = _laid_flat(V, F)
    i, j = np.roll(F, -1, axis=1), np.roll(F, -2, axis=1)
    edges = np.roll(flat, -2, axis=1) - np.roll(flat, -1, axis=1)
    L = edge_laplacian(np.column_stack([i.ravel(), j.ravel()]), weights.ravel(), n)
    pin = sp.csc_array(([1.0], ([0], [0])), shape=(n, n))
    solver = SparseCholesky(L + pin)
    ends = np.concatenate([j.ravel(), i.ravel()])
    signs = np.repeat([1.0, -1.0], 3 * len(F))
    columns = np.tile(np.arange(3 * len(F)), 2)
    gather = sp.csr_array((signs, (ends, columns)), shape=(n, 3 * len(F)))
    for _ in range(ROUNDS):
        now = uv[j] - uv[i]
        cosine = (weights * (now * edges).sum(axis=2)).sum(axis=1)
        sine = (weights * (now[..., 1] * edges[..., 0] - now[..., 0] * edges[..., 1])).sum(axis=1)
        size = np.maximum(np.hypot(cosine, sine), 1e-30)
        c, s = (cosine / size)[:, None], (sine / size)[:, None]
        turned = np.stack(
            [c * edges[..., 0] - s * edges[..., 1], s * edges[..., 0] + c * edges[..., 1]], axis=-1
        )
        pull = weights[..., None] * turned
        b = gather @ pull.reshape(-1, 2)
        b[0] += uv[0]
        uv = solver.solve(b)
    return uv


def _laid_flat(V: FloatArray, F: IntArray) -> FloatArray:
    """(m, 3, 2) every triangle in the plane on its own."""
    a, b = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    length = np.linalg.norm(a, axis=1)
    along = (a * b).sum(axis=1) / length
    height = np.linalg.norm(np.cross(a, b), axis=1) / length
    flat = np.zeros((len(F), 3, 2))
    flat[:, 1, 0], flat[:, 2, 0], flat[:, 2, 1] = length, along, height
    return flat
