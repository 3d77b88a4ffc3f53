"""How much larger the parts of a body have become, so that its detail grows with them."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


def size_ratio(before: FloatArray, after: FloatArray, F: IntArray, shares: FloatArray) -> FloatArray:
    """Compare the areas of the regions of two meshes.

    Parameters
    ----------
    before, after : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces of both.
    shares : (n, R) float
        Share of every vertex in every region.

    Returns
    -------
    (n,) ndarray
        Ratio of lengths: root of that of the areas of the regions of a vertex, blended by its shares.
    """
    ratio = np.ones(shares.shape[1])
    old, new = (shares.T @ _vertex_areas(V, F) for V in (before, after))
    np.sqrt(np.divide(new, old, out=ratio, where=(old > 0) & (new > 0)), out=ratio)
    bound = shares.sum(axis=1)
    return shares @ ratio + (1 - bound)


def _vertex_areas(V: FloatArray, F: IntArray) -> FloatArray:
    a, b, c = (V[F[:, i]] for i in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    total: FloatArray = np.bincount(F.ravel(), np.repeat(area / 3, 3), len(V)).astype(np.float64)
    return total
