"""One front for all faces round a vertex, also where the faces of a mesh are not oriented alike."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True)
def _join(corners: Any, agree: Any, above: Any, sign: Any) -> None:
    """Join corners to trees, each with its sign against its root."""
    for h in range(len(corners)):
        for end in range(2):
            a, b = corners[h, end, 0], corners[h, end, 1]
            s, t = agree[h], 1.0
            while above[a] != a:
                s, a = s * sign[a], above[a]
            while above[b] != b:
                t, b = t * sign[b], above[b]
            if a < b:
                above[b], sign[b] = a, s * t
            elif b < a:
                above[a], sign[a] = b, s * t


def corner_fronts(F: IntArray, hinges: Hinges) -> FloatArray:
    """Orient the faces round each vertex alike.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    hinges : Hinges
        Of the faces.

    Returns
    -------
    (m, 3) ndarray
        1 or -1 for every corner: whether the front of the face is that of its fan. All 1 where the faces
        are oriented alike; on a Moebius band each vertex has a fan that agrees, though not all together.
    """
    fronts = np.ones(F.shape)
    (f, g), (s, t) = hinges.faces.T, hinges.sides.T
    along_f, along_g = hinges.along[f, s], hinges.along[g, t]
    agree = np.where(along_f == along_g, -1.0, 1.0)
    if (agree > 0).all():
        return fronts
    low_f, low_g = np.where(along_f > 0, s, (s + 1) % 3), np.where(along_g > 0, t, (t + 1) % 3)
    high_f, high_g = np.where(along_f > 0, (s + 1) % 3, s), np.where(along_g > 0, (t + 1) % 3, t)
    ends = [
        np.stack([3 * f + low_f, 3 * g + low_g], axis=1),
        np.stack([3 * f + high_f, 3 * g + high_g], axis=1),
    ]
    above, sign = np.arange(F.size), np.ones(F.size)
    _join(np.stack(ends, axis=1), agree, above, sign)
    for _ in range(int(np.bincount(F.ravel()).max())):
        sign, above = np.where(above != above[above], sign * sign[above], sign), above[above]
    return sign.reshape(F.shape)
