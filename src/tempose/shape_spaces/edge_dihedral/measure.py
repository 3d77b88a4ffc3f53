"""Lengths of edges and signed dihedral angles of a mesh."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True)
def _lengths(V: Any, edges: Any, out: Any) -> None:
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        x, y, z = V[j, 0] - V[i, 0], V[j, 1] - V[i, 1], V[j, 2] - V[i, 2]
        out[e] = math.sqrt(x * x + y * y + z * z)


@numba.njit(cache=True, nogil=True)
def _normals(V: Any, F: Any, N: Any) -> int:
    """Compute unit normals; return the number of faces without one, whose rows stay zero."""
    flat = 0
    for f in range(len(F)):
        a, b, c = F[f, 0], F[f, 1], F[f, 2]
        ux, uy, uz = V[b, 0] - V[a, 0], V[b, 1] - V[a, 1], V[b, 2] - V[a, 2]
        vx, vy, vz = V[c, 0] - V[a, 0], V[c, 1] - V[a, 1], V[c, 2] - V[a, 2]
        wx, wy, wz = vx - ux, vy - uy, vz - uz
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        size = math.sqrt(x * x + y * y + z * z)
        longest = max(ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz)
        if size > 1e-12 * longest:
            N[f, 0], N[f, 1], N[f, 2] = x / size, y / size, z / size
        else:
            flat += 1
    return flat


@numba.njit(cache=True, nogil=True)
def _dihedrals(V: Any, N: Any, edges: Any, lengths: Any, faces: Any, edge: Any, slot: Any, out: Any) -> None:
    for h in range(len(edge)):
        f, g, e = faces[h, 0], faces[h, 1], edge[h]
        i, j = edges[e, 0], edges[e, 1]
        x = N[f, 1] * N[g, 2] - N[f, 2] * N[g, 1]
        y = N[f, 2] * N[g, 0] - N[f, 0] * N[g, 2]
        z = N[f, 0] * N[g, 1] - N[f, 1] * N[g, 0]
        sine = (x * (V[j, 0] - V[i, 0]) + y * (V[j, 1] - V[i, 1]) + z * (V[j, 2] - V[i, 2])) / lengths[e]
        cosine = N[f, 0] * N[g, 0] + N[f, 1] * N[g, 1] + N[f, 2] * N[g, 2]
        out[slot[h]] = math.atan2(sine, cosine)


def normals(V: FloatArray, F: IntArray, hinges: Hinges) -> FloatArray:
    """Compute a unit normal of every face, also of those whose corners lie on a line.

    Parameters
    ----------
    V : (n, 3) float
        Vertices; no edge may have length 0.
    F : (m, 3) int
        Faces.
    hinges : Hinges
        Of the faces.

    Returns
    -------
    (m, 3) ndarray
        Unit normals; a face without area takes that of its neighbours, made perpendicular to its line.
    """
    N = np.zeros((len(F), 3))
    if _normals(V, F, N):
        _borrow(V, F, hinges, N)
    return N


def _borrow(V: FloatArray, F: IntArray, hinges: Hinges, N: FloatArray) -> None:
    flat = np.flatnonzero(~N.any(axis=1))
    near = np.zeros(N.shape)
    for own, other in ((0, 1), (1, 0)):
        np.add.at(near, hinges.faces[:, own], N[hinges.faces[:, other]])
    sides = V[np.roll(F[flat], -1, axis=1)] - V[F[flat]]
    longest = np.linalg.norm(sides, axis=2).argmax(axis=1)
    line = sides[np.arange(len(flat)), longest]
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    # beside the neighbours' normals the axis least along the line: some perpendicular there always is
    spare = np.eye(3)[np.abs(line).argmin(axis=1)]
    wanted = near[flat] + 1e-6 * spare
    wanted -= np.sum(wanted * line, axis=1, keepdims=True) * line
    N[flat] = wanted / np.linalg.norm(wanted, axis=1, keepdims=True)


def lengths_and_dihedrals(V: FloatArray, F: IntArray, hinges: Hinges) -> tuple[FloatArray, FloatArray]:
    """Measure a mesh.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces.
    hinges : Hinges
        Of the faces.

    Returns
    -------
    lengths : (E,) ndarray
        Metres.
    dihedrals : (n_slots,) ndarray
        Radians in (-pi, pi]: 0 where two faces lie flat, positive where the surface is convex, 0 at the
        boundary.

    Raises
    ------
    ValueError
        If an edge has no length: no direction to turn about.
    """
    V, F = np.ascontiguousarray(V, dtype=np.float64), np.ascontiguousarray(F)
    lengths, dihedrals = np.zeros(len(hinges.edges)), np.zeros(hinges.n_slots)
    _lengths(V, hinges.edges, lengths)
    if not lengths.min() > 0:
        i, j = hinges.edges[int(lengths.argmin())]
        raise ValueError(
            f"V must give every edge a length, got vertices {i} and {j} of one face at the same point; "
            "merge them, or use space 'vertex'"
        )
    _dihedrals(
        V,
        normals(V, F, hinges),
        hinges.edges,
        lengths,
        hinges.faces,
        hinges.edge,
        hinges.slot,
        dihedrals,
    )
    return lengths, dihedrals
