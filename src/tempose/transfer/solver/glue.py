"""The fragmented mesh glued together again, eqs. (3)-(4)."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import scipy.sparse as sp

from tempose.geometry import cotangent_laplacian, cotangents, edge_laplacian
from tempose.linalg import SparseCholesky
from tempose.transfer.solver.frame_kernels import add_faces_1, add_faces_8
from tempose.transfer.solver.links import ExtraEdges
from tempose.typing import FloatArray, IntArray

Precision = Literal["single", "double"]
LANES = 8
"""Several frames are solved in multiples of so many."""


class PoissonGlue:
    """Find the mesh whose differential coordinates are those of its turned faces.

    The Laplacian is factorised once; all work on a frame happens in the order of the factor. Solved for is
    the displacement from the rest: exactly zero where nothing turns, and rounding is relative to it.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, metres.
    F : (m, 3) int
        Faces; with `extra` one connected component.
    extra : ExtraEdges
        Links between pieces and inner edges.
    precision : {"double", "single"}, default "double"
        Of the factor and the frames; the factor is computed in double.
    order : (n,) int, optional
        Order of elimination, found if not given.

    Raises
    ------
    ValueError
        If mesh and links are more than one component, or a vertex has no edge.
    """

    def __init__(
        self,
        V: FloatArray,
        F: IntArray,
        extra: ExtraEdges,
        precision: Precision = "double",
        order: IntArray | None = None,
    ) -> None:
        self.n = n = len(V)
        self.dtype: Any = np.float64 if precision == "double" else np.float32
        L = cotangent_laplacian(V, F) + edge_laplacian(extra.pairs, extra.weights, n)
        # the rows sum to zero, so that pulling one vertex to its place holds it there exactly
        pull = np.zeros(n)
        pull[0] = L.diagonal().mean()
        self._factor = SparseCholesky(L + sp.diags_array(pull), order=order).factor.astype(self.dtype)
        self.rows: IntArray = self._factor.permutation
        """(n,) int: row of each vertex in the order of the factor."""
        self._rest = V - V[0]
        corners = np.concatenate([F, np.column_stack([extra.pairs, np.full(len(extra.pairs), n)])])
        self._corners = np.append(self.rows, n)[corners].astype(np.int32)
        self._coordinates = np.concatenate([_face_coordinates(V, F), _edge_coordinates(V, extra)]).astype(
            self.dtype
        )
        # neighbours in memory are visited one after the other
        visit = np.argsort(self._corners.min(axis=1), kind="stable")
        self._corners = np.ascontiguousarray(self._corners[visit])
        self._coordinates = self._coordinates[visit].reshape(-1)

    def displacements(self, q: FloatArray) -> FloatArray:
        """Solve for rows of quaternions, see `frame_kernels`.

        Parameters
        ----------
        q : (n + 1, 4 K) ndarray
            Field of one frame or a multiple of eight frames, the last row zero.

        Returns
        -------
        (n + 1, 4) or (n + 1, 3 K) ndarray
            Displacements from the rest, vertex 0 held.
        """
        frames = q.shape[1] // 4
        u = np.zeros((self.n + 1, 4 if frames == 1 else 3 * frames), dtype=self.dtype)
        if frames == 1:
            add_faces_1(q.reshape(-1), self._corners, self._coordinates, u.reshape(-1))
        else:
            add_faces_8(q.reshape(-1), self._corners, self._coordinates, frames, u.reshape(-1))
        self._factor.solve_rows(u)
        return u

    def in_rows(self, q: FloatArray) -> FloatArray:
        """Bring a quaternion field into the order of the factor.

        Parameters
        ----------
        q : (n, 4, K) float
            Field at the vertices, wxyz.

        Returns
        -------
        (n + 1, 4 K') ndarray
            K' is one, or K filled up to a multiple of eight.
        """
        K = q.shape[2]
        if K == 1:
            out = np.zeros((self.n + 1, 4), dtype=self.dtype)
            out[self.rows] = q[:, [1, 2, 3, 0], 0]
            return out
        out = np.zeros((self.n + 1, 4, -(-K // LANES) * LANES), dtype=self.dtype)
        out[self.rows, :, :K] = q
        return out.reshape(self.n + 1, -1)

    def solve(self, q: FloatArray) -> FloatArray:
        """Glue K frames.

        Parameters
        ----------
        q : (n, 4, K) float
            Quaternion field at the vertices, wxyz; need not be normalised.

        Returns
        -------
        (K, n, 3) ndarray
            Vertices, each frame with vertex 0 at the origin.
        """
        K = q.shape[2]
        if K == 0:
            return np.zeros((0, self.n, 3))
        u = self.displacements(self.in_rows(q))[self.rows]
        if K == 1:
            return (self._rest + u[:, :3])[None]
        return self._rest + u.reshape(self.n, 3, -1)[:, :, :K].transpose(2, 0, 1)


def _face_coordinates(V: FloatArray, F: IntArray) -> FloatArray:
    """Laplacian coordinates of the first two corners of every face in itself, (m, 8)."""
    out = np.zeros((len(F), 8))
    wi, wj, wk = cotangents(V, F).T[:, :, None]
    a, b = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 1]]
    out[:, :3] = -(wk * a + wj * (a + b))
    out[:, 4:7] = wk * a - wi * b
    return out


def _edge_coordinates(V: FloatArray, extra: ExtraEdges) -> FloatArray:
    out = np.zeros((len(extra.pairs), 8))
    out[:, :3] = extra.weights[:, None] * (V[extra.pairs[:, 0]] - V[extra.pairs[:, 1]])
    out[:, 4:7] = -out[:, :3]
    return out
