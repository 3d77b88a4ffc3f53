"""Vertex normals in the frames of the faces, from lengths and heights."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.typing import FloatArray


@numba.njit(cache=True, nogil=True)
def _normals(face_edges: Any, along: Any, sides: Any, directions: Any, heights: Any, out: Any) -> None:
    for f in range(len(sides)):
        for k in range(3):
            b = (k + 2) % 3
            e, g = face_edges[f, k], face_edges[f, b]
            # slopes along the two sides that leave the corner
            p = heights[e, 0 if along[f, k] > 0 else 1] / sides[f, k]
            q = heights[g, 1 if along[f, b] > 0 else 0] / sides[f, b]
            a1, a2 = directions[f, k], directions[f, b] + math.pi
            c1, s1, c2, s2 = math.cos(a1), math.sin(a1), math.cos(a2), math.sin(a2)
            area = c1 * s2 - s1 * c2
            if abs(area) < 1e-12:
                x, y = 0.5 * (p * c1 + q * c2), 0.5 * (p * s1 + q * s2)
            else:
                x, y = (p * s2 - q * s1) / area, (q * c1 - p * c2) / area
            square = x * x + y * y
            if square > 1.0:
                # no unit vector has these slopes
                x, y = x / math.sqrt(square), y / math.sqrt(square)
            out[f, k, 0], out[f, k, 1] = x, y
            out[f, k, 2] = math.sqrt(max(0.0, 1.0 - square))


def normals_in_faces(
    hinges: Hinges, sides: FloatArray, directions: FloatArray, heights: FloatArray
) -> FloatArray:
    """Find the vertex normal at every corner, seen from the frame of the face.

    Parameters
    ----------
    hinges : Hinges
        Of the faces.
    sides : (m, 3) float
        Lengths, metres.
    directions : (m, 3) float
        Of the sides, as `lay_out` gives them.
    heights : (E, 2) float
        Metres.

    Returns
    -------
    (m, 3, 3) ndarray
        Unit vectors, face, corner, coordinate; the third is the size of the part along the face normal,
        whose sign lengths and heights do not tell.
    """
    out = np.zeros((len(sides), 3, 3))
    _normals(hinges.face_edges, hinges.along, sides, directions, np.ascontiguousarray(heights), out)
    return out
