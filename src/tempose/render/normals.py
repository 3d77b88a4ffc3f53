"""Normals to shade by: smooth across edges, or broken at sharp ones."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from tempose.typing import FloatArray, IntArray


def face_normals(V: FloatArray, F: IntArray) -> FloatArray:
    """Return the unit normals of triangles.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Triangles, counter-clockwise seen from outside.

    Returns
    -------
    (m, 3) ndarray of float64
        Unit normals; zero for a triangle without area.
    """
    return _unit(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]))


def corner_normals(V: FloatArray, F: IntArray, crease: float | None = None) -> FloatArray:
    """Return a normal for each corner of each triangle, averaged over the faces around it.

    Faces count by their angle at the vertex, so that the result does not depend on the diagonals of quads.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Triangles, counter-clockwise seen from outside.
    crease : float, optional
        Radians: faces whose normals differ by more do not share a normal. None smooths everything.

    Returns
    -------
    (m, 3, 3) ndarray of float64
        Unit normals by face, corner, coordinate; zero where no face around the corner has area.
    """
    N = face_normals(V, F)
    weights = _corner_angles(V, F)
    corner_of = np.arange(F.size)
    around = sparse.csr_matrix((weights.ravel(), (F.ravel(), corner_of)), shape=(len(V), F.size))
    N_corner = np.repeat(N, 3, axis=0)
    if crease is None:
        return _unit(around @ N_corner)[F]
    touch = sparse.csr_matrix((np.ones(F.size), (F.ravel(), corner_of)), shape=(len(V), F.size))
    pairs = (touch.T @ around).tocoo()
    near = (N_corner[pairs.row] * N_corner[pairs.col]).sum(axis=1) >= np.cos(crease) - 1e-9
    kept = sparse.csr_matrix((pairs.data[near], (pairs.row[near], pairs.col[near])), shape=pairs.shape)
    return _unit(kept @ N_corner).reshape(-1, 3, 3)


def _corner_angles(V: FloatArray, F: IntArray) -> FloatArray:
    P = V[F]
    a = _unit((np.roll(P, -1, axis=1) - P).reshape(-1, 3))
    b = _unit((np.roll(P, 1, axis=1) - P).reshape(-1, 3))
    return np.arccos(np.clip((a * b).sum(axis=1), -1.0, 1.0)).reshape(-1, 3)


def _unit(X: FloatArray) -> FloatArray:
    length = np.linalg.norm(X, axis=-1, keepdims=True)
    return X / np.where(length > 0, length, 1.0)
