"""Areas and normals."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


def _area_vectors(V: FloatArray, F: IntArray) -> FloatArray:
    a, b, c = (V[..., F[:, k], :] for k in range(3))
    return 0.5 * np.cross(b - a, c - a)


def face_areas(V: FloatArray, F: IntArray) -> FloatArray:
    """Area of every face.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (..., m) ndarray
        Areas, unit of `V` squared.
    """
    return np.linalg.norm(_area_vectors(V, F), axis=-1)


def face_normals(V: FloatArray, F: IntArray) -> FloatArray:
    """Compute the unit normal of every face; zero for a face without area.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices.
    F : (m, 3) int
        Faces, counter-clockwise seen from outside.

    Returns
    -------
    (..., m, 3) ndarray
        Outward unit normals.
    """
    N = _area_vectors(V, F)
    length = np.linalg.norm(N, axis=-1, keepdims=True)
    return N / np.where(length > 0, length, 1.0)


def vertex_areas(V: FloatArray, F: IntArray) -> FloatArray:
    """Third of the area of the faces round every vertex.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (n,) ndarray
        Areas; they sum to the area of the mesh.
    """
    areas = np.bincount(F.ravel(), np.repeat(face_areas(V, F) / 3, 3), minlength=len(V))
    return areas.astype(np.float64)


def vertex_normals(V: FloatArray, F: IntArray) -> FloatArray:
    """Area-weighted unit normal of every vertex; zero where there is no face.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (n, 3) ndarray
        Unit normals.
    """
    per_face = np.repeat(_area_vectors(V, F), 3, axis=0)
    N = np.column_stack([np.bincount(F.ravel(), per_face[:, k], minlength=len(V)) for k in range(3)])
    length = np.linalg.norm(N, axis=1, keepdims=True)
    return N / np.where(length > 0, length, 1.0)
