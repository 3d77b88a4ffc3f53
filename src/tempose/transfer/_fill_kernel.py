"""The loop that pushes a patch of skin out."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np


@numba.njit(cache=True, nogil=True, error_model="numpy")
def fill_patch(X: Any, F: Any, bump: Any, missing: Any, cap: float) -> None:
    """Move the vertices of a patch along its area vectors until the missing volume is there.

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
    """
    g = np.zeros((X.shape[1], 3))
    for t in range(X.shape[0]):
        g[:] = 0.0
        for f in range(F.shape[0]):
            i, j, k = F[f, 0], F[f, 1], F[f, 2]
            ax, ay, az = X[t, j, 0] - X[t, i, 0], X[t, j, 1] - X[t, i, 1], X[t, j, 2] - X[t, i, 2]
            bx, by, bz = X[t, k, 0] - X[t, i, 0], X[t, k, 1] - X[t, i, 1], X[t, k, 2] - X[t, i, 2]
            nx, ny, nz = (ay * bz - az * by) / 6, (az * bx - ax * bz) / 6, (ax * by - ay * bx) / 6
            for v in (i, j, k):
                g[v, 0] += nx
                g[v, 1] += ny
                g[v, 2] += nz
        rate = 0.0
        for v in range(X.shape[1]):
            rate += bump[v] * np.sqrt(g[v, 0] ** 2 + g[v, 1] ** 2 + g[v, 2] ** 2)
        push = cap * np.tanh(missing[t] / max(rate * cap, 1e-300))
        for v in range(X.shape[1]):
            length = np.sqrt(g[v, 0] ** 2 + g[v, 1] ** 2 + g[v, 2] ** 2)
            if length > 0:
                for c in range(3):
                    X[t, v, c] += push * bump[v] * g[v, c] / length
