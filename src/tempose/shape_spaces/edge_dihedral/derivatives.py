"""How lengths and dihedral angles change as vertices move, and the normal equations of both."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
import scipy.sparse as sp

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.typing import FloatArray, IntArray


@numba.njit(cache=True, nogil=True)
def _rows(
    V: Any, N: Any, edges: Any, lengths: Any, edge: Any, corners: Any, turns: Any, faces: Any, G: Any
) -> None:
    """Fill the gradients of the angles: lower end, higher end, apex of the first face, of the second."""
    for h in range(len(edge)):
        e = edge[h]
        i, j, size = edges[e, 0], edges[e, 1], lengths[e]
        G[h] = 0.0
        for side in range(2):
            f, k = faces[h, side], corners[h, side]
            foot = height = 0.0
            for c in range(3):
                foot += (V[k, c] - V[i, c]) * (V[j, c] - V[i, c])
            foot /= size * size
            for c in range(3):
                across = V[k, c] - V[i, c] - foot * (V[j, c] - V[i, c])
                height += across * across
            height = max(math.sqrt(height), 1e-3 * size)
            turn = -turns[h, 0] if side == 0 else turns[h, 1]
            for c in range(3):
                pull = turn * N[f, c] / height
                G[h, 2 + side, c] = pull
                G[h, 0, c] -= (1.0 - foot) * pull
                G[h, 1, c] -= foot * pull


@numba.njit(cache=True, nogil=True)
def _add(G: Any, weights: Any, residuals: Any, vertices: Any, blocks: Any, A: Any, b: Any) -> None:
    for h in range(len(G)):
        w = weights[h] * weights[h]
        for p in range(G.shape[1]):
            v = vertices[h, p]
            for c in range(3):
                b[v, c] -= weights[h] * residuals[h] * G[h, p, c]
            for q in range(G.shape[1]):
                k = blocks[h, p, q]
                for c in range(3):
                    for d in range(3):
                        A[k, c, d] += w * G[h, p, c] * G[h, q, d]


class NormalEquations:
    """Pattern of the normal equations of a mesh, filled again for every step.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    hinges : Hinges
        Of the faces.
    """

    def __init__(self, F: IntArray, n: int, hinges: Hinges) -> None:
        self.hinges, self.n = hinges, n
        f, g = hinges.faces.T
        apex = [F[f, (hinges.sides[:, 0] + 2) % 3], F[g, (hinges.sides[:, 1] + 2) % 3]]
        self.corners = np.column_stack(apex)
        self.turns = np.column_stack(
            [hinges.along[f, hinges.sides[:, 0]], hinges.along[g, hinges.sides[:, 1]]]
        ).astype(np.float64)
        self.of_hinge = np.column_stack([hinges.edges[hinges.edge], *apex])
        pairs = [_pairs(self.of_hinge, n), _pairs(hinges.edges, n), np.arange(n) * (n + 1)]
        keys, inverse = np.unique(np.concatenate([p.ravel() for p in pairs]), return_inverse=True)
        split = np.split(inverse.ravel(), np.cumsum([p.size for p in pairs])[:-1])
        self.hinge_blocks, self.edge_blocks = (
            split[0].reshape(pairs[0].shape),
            split[1].reshape(pairs[1].shape),
        )
        self.diagonal = split[2]
        self.indices = (keys % n).astype(np.int32)
        self.indptr = np.searchsorted(keys, np.arange(n + 1) * n).astype(np.int32)

    def graph(self) -> Any:
        """Return which vertices are coupled.

        Returns
        -------
        (n, n) scipy.sparse.csr_array
            Ones.
        """
        return sp.csr_array((np.ones(len(self.indices)), self.indices, self.indptr), shape=(self.n, self.n))

    def angle_gradients(self, V: FloatArray, N: FloatArray, lengths: FloatArray) -> FloatArray:
        """Differentiate the dihedral angles.

        Parameters
        ----------
        V : (n, 3) float
            Vertices.
        N : (m, 3) float
            Unit normals of the faces.
        lengths : (E,) float
            Of the edges.

        Returns
        -------
        (H, 4, 3) ndarray
            By the vertices of `of_hinge`; heights of faces are taken as at least 0.1 % of the edge.
        """
        hinges = self.hinges
        G = np.zeros((len(hinges.edge), 4, 3))
        _rows(V, N, hinges.edges, lengths, hinges.edge, self.corners, self.turns, hinges.faces, G)
        return G

    def length_gradients(self, V: FloatArray, lengths: FloatArray) -> FloatArray:
        """Differentiate the lengths.

        Parameters
        ----------
        V : (n, 3) float
            Vertices.
        lengths : (E,) float
            Of the edges.

        Returns
        -------
        (E, 2, 3) ndarray
            By the lower and the higher end.
        """
        u = (V[self.hinges.edges[:, 1]] - V[self.hinges.edges[:, 0]]) / lengths[:, None]
        return np.stack([-u, u], axis=1)

    def system(
        self,
        terms: tuple[tuple[FloatArray, FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]],
    ) -> tuple[FloatArray, FloatArray]:
        """Sum the equations up.

        Parameters
        ----------
        terms : two tuples of ndarray
            Gradients, weights and weighted residuals of the lengths, and of the angles.

        Returns
        -------
        blocks : (b, 3, 3) ndarray
            Of ``J^T J``, in the pattern of `graph`.
        rhs : (n, 3) ndarray
            ``-J^T r``.
        """
        A, b = np.zeros((len(self.indices), 3, 3)), np.zeros((self.n, 3))
        patterns = ((self.hinges.edges, self.edge_blocks), (self.of_hinge, self.hinge_blocks))
        for (G, weights, residuals), (vertices, blocks) in zip(terms, patterns):
            _add(G, weights, residuals, vertices, blocks, A, b)
        return A, b


def _pairs(vertices: IntArray, n: int) -> IntArray:
    return vertices[:, :, None].astype(np.int64) * n + vertices[:, None, :]
