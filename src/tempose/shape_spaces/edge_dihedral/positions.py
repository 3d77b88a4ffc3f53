"""Vertices from the sides of the faces, by least squares."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.geometry import edge_laplacian, vertex_components
from tempose.linalg import SparseCholesky
from tempose.typing import FloatArray, IntArray

_WEIGHTS = (0.01, 20.0)


@numba.njit(cache=True, nogil=True)
def _gather(F: Any, weights: Any, sides: Any, apex: Any, R: Any, rhs: Any) -> None:
    for f in range(len(F)):
        for k in range(3):
            if k == 0:
                x, y = sides[f, 0], 0.0
            elif k == 1:
                x, y = apex[f, 0] - sides[f, 0], apex[f, 1]
            else:
                x, y = -apex[f, 0], -apex[f, 1]
            i, j = F[f, k], F[f, (k + 1) % 3]
            for c in range(3):
                pull = weights[f, k] * (R[f, c, 0] * x + R[f, c, 1] * y)
                rhs[i, c] -= pull
                rhs[j, c] += pull


class VertexPositions:
    """Fit vertices to faces that are turned but lie apart; factorised once for a mesh.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    apex : (m, 2) float
        Corner 2 of each face at rest, corner 0 at the origin and corner 1 at ``(sides[:, 0], 0)``.
    sides : (m, 3) float
        Lengths at rest.

    Notes
    -----
    Minimises ``sum w |x_j - x_i - R_f u|^2`` over the sides of all faces, w the cotangent of the angle
    opposite at rest, kept within (0.01, 20): a Poisson equation. One vertex of each component stays at 0.
    """

    def __init__(self, F: IntArray, n: int, sides: FloatArray, apex: FloatArray) -> None:
        self.F = np.ascontiguousarray(F, dtype=np.int64)
        self.n = n
        corner = [np.zeros((len(F), 2)), np.column_stack([sides[:, 0], 0 * sides[:, 0]]), apex]
        weights = np.zeros(self.F.shape)
        for k in range(3):
            a, b = corner[k] - corner[(k + 2) % 3], corner[(k + 1) % 3] - corner[(k + 2) % 3]
            double_area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
            weights[:, k] = np.sum(a * b, axis=1) / np.maximum(double_area, 1e-300)
        self.weights = np.clip(weights, *_WEIGHTS)
        edges = np.concatenate([self.F[:, [k, (k + 1) % 3]] for k in range(3)])
        L = edge_laplacian(edges, self.weights.T.ravel(), n)
        held = np.unique(vertex_components(self.F, n)[1], return_index=True)[1]
        self.free = np.setdiff1d(np.arange(n), held)
        self.solver = SparseCholesky(L[self.free][:, self.free])

    def solve(self, sides: FloatArray, apex: FloatArray, rotations: FloatArray) -> FloatArray:
        """Fit the vertices.

        Parameters
        ----------
        sides : (m, 3) float
            Lengths.
        apex : (m, 2) float
            Layout of each face, as `lay_out` gives it.
        rotations : (m, 3, 3) float
            Frame of each face in columns.

        Returns
        -------
        (n, 3) ndarray
            Vertices; each component somewhere.
        """
        rhs = np.zeros((self.n, 3))
        _gather(self.F, self.weights, sides, apex, rotations, rhs)
        X = np.zeros((self.n, 3))
        X[self.free] = self.solver.solve(rhs[self.free])
        return X
