"""The loop that pushes a patch of skin out."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np


@numba.njit(cache=True, nogil=True, error_model="numpy")
def fill_patch(X: Any, F: Any, bump: Any, missing: Any, cap: float, smooth: int) -> None:
    """Move the vertices of a patch outwards until the missing volume is there.

    Parameters
    ----------
    X : (K, p, 3) ndarray
        Frames of the patch; changed in place.
    F : (q, 3) int ndarray
        Its faces.
    bump : (p,) ndarray
        Share of the push that each vertex takes.
    missing : (K,) ndarray
        Volume to give back.
    cap : float
        Furthest push, approached softly.
    smooth : int
        How often the directions are averaged over the faces, so that a crease opens rather than folds.
    """
    n = X.shape[1]
    g, d, e = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for t in range(X.shape[0]):
        _gradient(X[t], F, g)
        d[:] = g
        for _ in range(smooth):
            e[:] = 0.0
            for f in range(F.shape[0]):
                i, j, k = F[f, 0], F[f, 1], F[f, 2]
                for c in range(3):
                    total = d[i, c] + d[j, c] + d[k, c]
                    e[i, c] += total
                    e[j, c] += total
                    e[k, c] += total
            d[:] = e
        rate = 0.0
        for v in range(n):
            length = np.sqrt(d[v, 0] ** 2 + d[v, 1] ** 2 + d[v, 2] ** 2)
            scale = bump[v] / length if length > 0 else 0.0
            for c in range(3):
                d[v, c] *= scale
                rate += d[v, c] * g[v, c]
        if rate > 0:
            push = cap * np.tanh(missing[t] / (rate * cap))
            for v in range(n):
                for c in range(3):
                    X[t, v, c] += push * d[v, c]


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _gradient(X: Any, F: Any, g: Any) -> None:
    """Write the gradient of the volume, a third of the area vectors round each vertex."""
    g[:] = 0.0
    for f in range(F.shape[0]):
        i, j, k = F[f, 0], F[f, 1], F[f, 2]
        ax, ay, az = X[j, 0] - X[i, 0], X[j, 1] - X[i, 1], X[j, 2] - X[i, 2]
        bx, by, bz = X[k, 0] - X[i, 0], X[k, 1] - X[i, 1], X[k, 2] - X[i, 2]
        nx, ny, nz = (ay * bz - az * by) / 6, (az * bx - ax * bz) / 6, (ax * by - ay * bx) / 6
        for v in (i, j, k):
            g[v, 0] += nx
            g[v, 1] += ny
            g[v, 2] += nz
