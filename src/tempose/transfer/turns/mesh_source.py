"""Rotations of marked places on a deforming mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose.geometry import face_normals, k_rings
from tempose.rotations import from_matrix, polar_rotation
from tempose.typing import FloatArray, IntArray

RINGS = 2
"""One ring is noisy, three blur a hoof."""


def patch_rotations(V: FloatArray, V_rest: FloatArray, F: IntArray, seeds: list[IntArray]) -> FloatArray:
    """Rotation of a patch of surface round each mark: the polar factor of its best linear map.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames of the source.
    V_rest : (n, 3) float
        Its reference pose.
    F : (m, 3) int
        Faces.
    seeds : list of (r,) int
        Vertices of each of k patches.

    Returns
    -------
    (T, k, 4) ndarray
        Unit quaternions wxyz. A patch of one face is completed by its normal.
    """
    k = len(seeds)
    rows = np.repeat(np.arange(k), [len(s) for s in seeds])
    columns = np.concatenate(seeds)
    share = np.concatenate([np.full(len(s), 1 / len(s)) for s in seeds])
    mean: Any = sp.coo_array((share, (rows, columns)), shape=(k, len(V_rest))).tocsr()
    P = V_rest[columns] - (mean @ V_rest)[rows]
    extra, extra_rest = _thin_normals(V_rest, F, seeds)
    Q = np.zeros((len(V), k, 4))
    for t, frame in enumerate(np.asarray(V, dtype=np.float64)):
        moved = frame[columns] - (mean @ frame)[rows]
        A = np.zeros((k, 3, 3))
        np.add.at(A, rows, moved[:, :, None] * P[:, None, :])
        if len(extra):
            now = face_normals(frame, np.array([seeds[i] for i in extra]))
            size = np.sqrt(np.trace(A[extra], axis1=1, axis2=2).clip(1e-30))[:, None, None]
            A[extra] += size**2 * now[:, :, None] * extra_rest[:, None, :]
        Q[t] = from_matrix(polar_rotation(A))
    return Q


def _thin_normals(V_rest: FloatArray, F: IntArray, seeds: list[IntArray]) -> tuple[IntArray, FloatArray]:
    """Patches of three vertices are flat: they need their normal to fix a rotation."""
    thin = np.array([i for i, s in enumerate(seeds) if len(s) == 3], dtype=np.int64)
    if len(thin) == 0:
        return thin, np.zeros((0, 3))
    return thin, face_normals(V_rest, np.array([seeds[i] for i in thin]))


def vertex_patches(F: IntArray, n: int, vertices: IntArray, rings: int = RINGS) -> list[IntArray]:
    """Patches round vertices.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    vertices : (k,) int
        Middle of each patch.
    rings : int, default 2
        How many edges it reaches.

    Returns
    -------
    list of (r,) ndarray of int
        Vertices of each patch.
    """
    return k_rings(F, n, vertices, rings)


def face_patches(F: IntArray, n: int, faces: IntArray, rings: int = RINGS) -> list[IntArray]:
    """Patches round faces.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    faces : (k,) int
        Middle of each patch.
    rings : int, default 2
        How many edges it reaches; 0 for the face alone.

    Returns
    -------
    list of (r,) ndarray of int
        Vertices of each patch.
    """
    if rings == 0:
        return list(F[faces])
    corners = k_rings(F, n, F[faces].ravel(), rings)
    return [np.unique(np.concatenate(corners[3 * i : 3 * i + 3])) for i in range(len(faces))]
