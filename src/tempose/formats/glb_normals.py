"""Vertex normals of a clip, frame after frame."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from tempose.typing import FloatArray, IntArray


class UnitNormals:
    """Vertex normals of many poses of one mesh.

    The sum over the faces round each vertex is one sparse product, set up once: without that normals are most
    of the time it takes to write a clip.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    """

    def __init__(self, F: IntArray, n: int) -> None:
        self._corners = np.ascontiguousarray(F.T)
        faces = np.tile(np.arange(len(F)), 3)
        ones = np.ones(3 * len(F), np.float32)
        self._around = sparse.csr_array((ones, (self._corners.ravel(), faces)), shape=(n, len(F)))

    def __call__(self, V: FloatArray) -> FloatArray:
        """Area-weighted normals, unit everywhere as glTF wants them.

        Parameters
        ----------
        V : (n, 3) float
            Vertices.

        Returns
        -------
        (n, 3) ndarray of float32
            +Z where there is no normal.
        """
        # offsets from one vertex keep their digits far from the origin and at any size
        size = float(np.abs(V - V[:1]).max()) or 1.0
        x, y, z = ((V - V[:1]) / size).astype(np.float32).T
        a, b, c = self._corners
        ux, uy, uz = x[b] - x[a], y[b] - y[a], z[b] - z[a]
        vx, vy, vz = x[c] - x[a], y[c] - y[a], z[c] - z[a]
        area = np.column_stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx])
        N: FloatArray = np.asarray(self._around @ area)
        length = np.linalg.norm(N, axis=1)
        N[length == 0] = [0.0, 0.0, 1.0]
        return N / np.where(length > 0, length, np.float32(1.0))[:, None]
