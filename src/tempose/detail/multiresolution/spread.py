"""Radial basis functions that carry what is known at few vertices to all of them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import KDTree

from tempose.typing import FloatArray

_APART = 0.1
"""Diagonals that lie between two vertices whose skin weights have nothing in common."""
_LARGEST_BLOCK = 4096


def spreading(
    V: FloatArray,
    centres: FloatArray,
    weights: FloatArray | None = None,
    centre_weights: FloatArray | None = None,
    *,
    nearest: int = 16,
) -> csr_matrix:
    """Interpolate from centres to vertices, as one sparse matrix.

    Parameters
    ----------
    V : (n, 3) float
        Vertices at rest, any unit.
    centres : (K, 3) float
        Where values are known, at rest.
    weights : (n, J) float, optional
        Skin weights of the vertices: a hand beside a hip then takes nothing from it.
    centre_weights : (K, J) float, optional
        Skin weights of the centres; needed with `weights`.
    nearest : int, default 16
        Centres that a vertex listens to.

    Returns
    -------
    (n, K) csr_matrix of float64
        Rows sum to 1; a vertex at a centre takes its value exactly.

    Notes
    -----
    The kernel is ``-|x - y|`` with a constant, conditionally positive definite in any number of dimensions,
    so skin weights may stand beside the coordinates, and the system of every vertex has a solution as long as
    no two of its centres coincide.
    """
    size = max(float(np.linalg.norm(np.ptp(V, axis=0))), 1e-300)
    X, C = V / size, centres / size
    if weights is not None and centre_weights is not None:
        X = np.column_stack([X, _APART / np.sqrt(2) * weights])
        C = np.column_stack([C, _APART / np.sqrt(2) * centre_weights])
    m = min(nearest, len(C))
    near = np.asarray(KDTree(C).query(X, k=m)[1], dtype=np.int64).reshape(len(X), m)
    shares = np.concatenate(
        [
            _shares(X[s : s + _LARGEST_BLOCK], C[near[s : s + _LARGEST_BLOCK]])
            for s in range(0, len(X), _LARGEST_BLOCK)
        ]
    )
    starts = np.arange(len(X) + 1) * m
    matrix = csr_matrix((shares.ravel(), near.ravel(), starts), (len(X), len(C)))
    matrix.sort_indices()
    return matrix


def _shares(X: FloatArray, near: FloatArray) -> FloatArray:
    """(b, m) shares of the m centres of each vertex: one small saddle-point system a vertex."""
    b, m, _ = near.shape
    A = np.zeros((b, m + 1, m + 1))
    A[:, :m, :m] = -np.linalg.norm(near[:, :, None] - near[:, None], axis=-1)
    A[:, m, :m] = A[:, :m, m] = 1.0
    # centres that coincide share their value instead of breaking the system
    A[:, np.arange(m), np.arange(m)] += 1e-12
    right = np.ones((b, m + 1, 1))
    right[:, :m, 0] = -np.linalg.norm(near - X[:, None], axis=-1)
    return np.linalg.solve(A, right)[:, :m, 0]
