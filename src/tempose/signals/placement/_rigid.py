"""The inner loops of placing: rotation and translation of every vertex."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np


@numba.njit(cache=True, nogil=True)
def place_each(V: Any, placements: Any, out: Any) -> None:
    """Compute ``R v + t``.

    Parameters
    ----------
    V : (k, n, 3) float
        Vertices.
    placements : (k, 7) float
        Rotations wxyz of any length, a zero one turning nothing, and translations.
    out : (k, n, 3) float
        Written; may be `V`.
    """
    for k in range(len(V)):
        a, b, c, d, e, f, g, h, i = _matrix(placements[k])
        tx, ty, tz = placements[k, 4], placements[k, 5], placements[k, 6]
        for v in range(V.shape[1]):
            x, y, z = V[k, v, 0], V[k, v, 1], V[k, v, 2]
            out[k, v, 0] = a * x + b * y + c * z + tx
            out[k, v, 1] = d * x + e * y + f * z + ty
            out[k, v, 2] = g * x + h * y + i * z + tz


@numba.njit(cache=True, nogil=True)
def unplace_each(V: Any, placements: Any, out: Any) -> None:
    """Compute ``R^T (v - t)``.

    Parameters
    ----------
    V : (k, n, 3) float
        Vertices.
    placements : (k, 7) float
        Rotations wxyz of any length, a zero one turning nothing, and translations.
    out : (k, n, 3) float
        Written; may be `V`.
    """
    for k in range(len(V)):
        a, b, c, d, e, f, g, h, i = _matrix(placements[k])
        tx, ty, tz = placements[k, 4], placements[k, 5], placements[k, 6]
        for v in range(V.shape[1]):
            x, y, z = V[k, v, 0] - tx, V[k, v, 1] - ty, V[k, v, 2] - tz
            out[k, v, 0] = a * x + d * y + g * z
            out[k, v, 1] = b * x + e * y + h * z
            out[k, v, 2] = c * x + f * y + i * z


@numba.njit(cache=True, nogil=True)
def _matrix(q: Any) -> Any:
    w, x, y, z = q[0], q[1], q[2], q[3]
    length = np.sqrt(w * w + x * x + y * y + z * z)
    if length > 0:
        w, x, y, z = w / length, x / length, y / length, z / length
    else:
        w = 1.0
    return (
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    )
