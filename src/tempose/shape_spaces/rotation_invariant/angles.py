"""Dihedral angles from vertex normals that the faces beside an edge see both."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True)
def _views(faces: Any, sides: Any, along: Any, directions: Any, N: Any, corners: Any, views: Any) -> None:
    """For each hinge, end of its edge and face: the corner, and the normal across and above the face."""
    for h in range(len(faces)):
        for side in range(2):
            f, k = faces[h, side], sides[h, side]
            angle = directions[f, k]
            turn = 1.0 if along[f, k] > 0 else -1.0
            s, c = turn * math.sin(angle), turn * math.cos(angle)
            for end in range(2):
                low = end == 0
                corner = k if low == (along[f, k] > 0) else (k + 1) % 3
                corners[h, end, side] = 3 * f + corner
                views[h, end, side, 0] = -N[f, corner, 0] * s + N[f, corner, 1] * c
                views[h, end, side, 1] = N[f, corner, 2]


def views_of_normals(hinges: Hinges, directions: FloatArray, N: FloatArray) -> tuple[IntArray, FloatArray]:
    """See the normals at both ends of every hinge from both of its faces, in the plane across the edge.

    Parameters
    ----------
    hinges : Hinges
        Of the faces.
    directions : (m, 3) float
        Of the sides.
    N : (m, 3, 3) float
        Normals in the frames of the faces.

    Returns
    -------
    corners : (H, 2, 2) ndarray of int64
        Hinge, end (lower vertex first), face: the corner, ``3 * face + k``.
    views : (H, 2, 2, 2) ndarray
        The same, then: part of the normal across the edge within the face, part along the face normal.
    """
    H = len(hinges.faces)
    corners, views = np.zeros((H, 2, 2), dtype=np.int64), np.zeros((H, 2, 2, 2))
    _views(hinges.faces, hinges.sides, hinges.along, directions, N, corners, views)
    return corners, views


@numba.njit(cache=True, nogil=True)
def turned(views: Any, h: int, end: int, s: float, t: float) -> tuple[float, float]:
    """Cosine and sine of a dihedral as one end sees it, times the square of the normal's part across.

    Parameters
    ----------
    views : (H, 2, 2, 2) ndarray
        As `views_of_normals` gives them.
    h, end : int
        Hinge and end.
    s, t : float
        Signs of the parts along the normals of the first and the second face.

    Returns
    -------
    tuple of float
        Real and imaginary part of ``(p_f + i c_f) conj(p_g + i c_g)``.
    """
    p, c = views[h, end, 0, 0], s * views[h, end, 0, 1]
    q, d = views[h, end, 1, 0], t * views[h, end, 1, 1]
    return p * q + c * d, c * q - p * d


@numba.njit(cache=True, nogil=True)
def _dihedrals(views: Any, corners: Any, signs: Any, slot: Any, out: Any) -> None:
    for h in range(len(slot)):
        x = y = 0.0
        for end in range(2):
            a, b = turned(views, h, end, signs[corners[h, end, 0]], signs[corners[h, end, 1]])
            x, y = x + a, y + b
        out[slot[h]] = math.atan2(y, x)


def dihedrals_from_normals(
    hinges: Hinges, corners: IntArray, views: FloatArray, signs: FloatArray
) -> FloatArray:
    """Find the dihedral angles on which both ends of each edge agree best.

    Parameters
    ----------
    hinges : Hinges
        Of the faces.
    corners, views : ndarray
        As `views_of_normals` gives them.
    signs : (3 m,) float
        1 or -1 for every corner.

    Returns
    -------
    (n_slots,) ndarray
        Radians.
    """
    out = np.zeros(hinges.n_slots)
    _dihedrals(views, corners, signs, hinges.slot, out)
    return out
