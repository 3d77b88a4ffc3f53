"""Where a surface is thin: the nearest vertex on the other side of a wall, such as a skirt's."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.typing import FloatArray, IntArray


def facing_through(V: FloatArray, normals: FloatArray, radius: float) -> IntArray:
    """Find for every vertex the nearest one inwards, within a radius, that faces the other way.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    normals : (n, 3) float
        Unit normals, outwards; zero where there is none.
    radius : float
        Above 0, a share of the mesh's size: its box is cut into cells of this edge.

    Returns
    -------
    (n,) ndarray of int
        Its index, -1 where there is none.
    """
    low = V.min(axis=0)
    cell = ((V - low) / radius).astype(np.int64) + 1
    # a rim of empty cells all round
    shape = cell.max(axis=0) + 2
    key = (cell[:, 0] * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2]
    members = np.argsort(key, kind="stable")
    start = np.searchsorted(key[members], np.arange(int(np.prod(shape)) + 1))
    return _nearest(
        np.ascontiguousarray(V, dtype=np.float64),
        np.ascontiguousarray(normals),
        radius,
        key,
        shape,
        start,
        members,
    )


@numba.njit(cache=True, nogil=True)
def _nearest(V: Any, normals: Any, radius: Any, key: Any, shape: Any, start: Any, members: Any) -> Any:
    partner = np.full(len(V), -1)
    for i in range(len(V)):
        a, b, c = normals[i, 0], normals[i, 1], normals[i, 2]
        best = radius * radius
        for dx in range(-1, 2):
            for dy in range(-1, 2):
                # three cells along z lie side by side
                row = key[i] + (dx * shape[1] + dy) * shape[2]
                for p in range(start[row - 1], start[row + 2]):
                    j = members[p]
                    if a * normals[j, 0] + b * normals[j, 1] + c * normals[j, 2] >= -0.5:
                        continue
                    x, y, z = V[i, 0] - V[j, 0], V[i, 1] - V[j, 1], V[i, 2] - V[j, 2]
                    squared = x * x + y * y + z * z
                    inward = a * x + b * y + c * z
                    if 0.0 < squared < best and inward > 0.9 * np.sqrt(squared):
                        best, partner[i] = squared, j
    return partner
