"""Heights of neighbours over the tangent plane of each vertex."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.shape_spaces.edge_dihedral.measure import normals
from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True)
def _add_normals(V: Any, F: Any, N: Any, fronts: Any, out: Any) -> None:
    for f in range(len(F)):
        for k in range(3):
            i, j, m = F[f, k], F[f, (k + 1) % 3], F[f, (k + 2) % 3]
            ax, ay, az = V[j, 0] - V[i, 0], V[j, 1] - V[i, 1], V[j, 2] - V[i, 2]
            bx, by, bz = V[m, 0] - V[i, 0], V[m, 1] - V[i, 1], V[m, 2] - V[i, 2]
            x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            angle = math.atan2(math.sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz)
            for c in range(3):
                out[i, c] += fronts[f, k] * angle * N[f, c]


@numba.njit(cache=True, nogil=True)
def _heights(V: Any, N: Any, edges: Any, out: Any) -> None:
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        for c in range(3):
            step = V[j, c] - V[i, c]
            out[e, 0] += N[i, c] * step
            out[e, 1] -= N[j, c] * step


def angle_weighted_normals(
    V: FloatArray, F: IntArray, face_normals: FloatArray, fronts: FloatArray
) -> FloatArray:
    """Mean of the normals round each vertex, weighed by the angles of the faces.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    face_normals : (m, 3) float
        Unit normals.
    fronts : (m, 3) float
        As `corner_fronts` gives them.

    Returns
    -------
    (n, 3) ndarray
        Unit normals; where those of the faces cancel, that of one face; zero for a loose vertex.
    """
    N = np.zeros(V.shape)
    _add_normals(V, F, face_normals, fronts, N)
    length = np.linalg.norm(N, axis=1)
    lost = np.flatnonzero(length < 1e-9)
    if len(lost):
        first = np.full(len(V), -1)
        first[F[::-1].ravel()] = np.repeat(np.arange(len(F))[::-1], 3)
        lost = lost[first[lost] >= 0]
        N[lost], length[lost] = face_normals[first[lost]], 1.0
    return N / np.where(length > 0, length, 1.0)[:, None]


def heights_and_cosines(
    V: FloatArray, F: IntArray, hinges: Hinges, fronts: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Measure heights, and on which side of its faces each vertex normal lies.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres; every edge has a length.
    F : (m, 3) int
        Faces.
    hinges : Hinges
        Of the faces.
    fronts : (m, 3) float
        As `corner_fronts` gives them.

    Returns
    -------
    heights : (E, 2) ndarray
        ``N_i . (x_j - x_i)`` and ``N_j . (x_i - x_j)`` of each edge (i, j), metres.
    cosines : (m, 3) ndarray
        ``N_i . n_f`` at every corner i of face f, negative where the surface folds over.
    """
    V, F = np.ascontiguousarray(V, dtype=np.float64), np.ascontiguousarray(F)
    face_normals = normals(V, F, hinges)
    N = angle_weighted_normals(V, F, face_normals, fronts)
    heights = np.zeros((len(hinges.edges), 2))
    _heights(V, N, hinges.edges, heights)
    return heights, np.einsum("fkc,fc->fk", N[F], face_normals)
