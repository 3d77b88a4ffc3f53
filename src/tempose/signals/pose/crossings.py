"""Places where the way from frame to frame crosses itself."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


def find_crossings(P: FloatArray) -> IntArray:
    """Return the pairs of transitions whose straight segments cross.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames in the pose plane, in order of time.

    Returns
    -------
    (c, 2) ndarray of int
        Segments i < j, from frame i to i + 1 and from j to j + 1, that cross within both; segments that
        only touch are not counted.
    """
    a, b = P[:-1], P[1:]

    def side(o: FloatArray, d: FloatArray, p: FloatArray) -> FloatArray:
        # of every point p relative to every segment o -> d
        u, v = (d - o)[:, None], p[None] - o[:, None]
        return np.sign(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    apart = side(a, b, a) * side(a, b, b) < 0
    return np.argwhere(np.triu(apart & apart.T, 2))
