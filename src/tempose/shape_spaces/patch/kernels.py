"""Sums over patches, and frames turned with them."""

from __future__ import annotations

from typing import Any

import numba


@numba.njit(cache=True, nogil=True)
def sum_turns(turned: Any, mean: Any, shares: Any, patch: Any, out: Any) -> None:
    """Sum over each patch the rotations from mean frames to turned ones.

    Parameters
    ----------
    turned, mean : (9 m + 3,) ndarray
        Frames of the faces.
    shares : (m,) ndarray
        Weights.
    patch : (m,) int ndarray
        Patch of each face.
    out : (p, 3, 3) ndarray
        Written.
    """
    m = len(shares)
    out[:] = 0.0
    for f in range(m):
        p, w = patch[f], shares[f]
        for i in range(3):
            a, b, c = w * turned[i * m + f], w * turned[(3 + i) * m + f], w * turned[(6 + i) * m + f]
            for j in range(3):
                out[p, i, j] += a * mean[j * m + f] + b * mean[(3 + j) * m + f] + c * mean[(6 + j) * m + f]


@numba.njit(cache=True, nogil=True)
def turn_frames(P: Any, patch: Any, mean: Any, out: Any) -> None:
    """Turn frames with the patch they lie in.

    Parameters
    ----------
    P : (p, 3, 3) ndarray
        Rotations of the patches.
    patch : (m,) int ndarray
        Patch of each face.
    mean : (9 m + 3,) ndarray
        Frames of the faces.
    out : (9 m + 3,) ndarray
        Written, but for the last three.
    """
    m = len(patch)
    for k in range(3):
        for i in range(3):
            for f in range(m):
                p = patch[f]
                x, y, z = mean[3 * k * m + f], mean[(3 * k + 1) * m + f], mean[(3 * k + 2) * m + f]
                out[(3 * k + i) * m + f] = P[p, i, 0] * x + P[p, i, 1] * y + P[p, i, 2] * z
