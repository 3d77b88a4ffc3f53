"""The mesh whose edges fit given ones best, in the sense of least squares: one factor, many frames."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from tempose.geometry import edge_laplacian, vertex_areas, vertex_components
from tempose.linalg import SparseCholesky
from tempose.shape_spaces.gradient.place_kernels import centres, write_vertices
from tempose.shape_spaces.gradient.rest_faces import RestFaces
from tempose.typing import FloatArray, IntArray

COTANGENTS = (0.01, 20.0)
"""Least and largest cotangent of a corner: below, the system is not definite, above it loses accuracy."""


class MeshPoisson:
    """Fit vertices to deformed faces, each connected piece about a centre of its own.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, metres.
    F : (m, 3) int
        Faces.
    rest : RestFaces
        The same faces described.

    Notes
    -----
    Minimises the sum over faces and corners k of ``c_k |(v_i - v_j) - T (r_i - r_j)|^2``, (i, j) the edge
    opposite to the corner, r at rest, c_k half the clamped cotangent. Any positive weights reproduce edges
    that do fit together.
    """

    def __init__(self, V: FloatArray, F: IntArray, rest: RestFaces) -> None:
        n = len(V)
        weights = corner_weights(rest)
        a, b, c = rest.corners
        pairs = np.concatenate([np.stack(p, axis=1) for p in ((b, c), (c, a), (a, b))])
        L = edge_laplacian(pairs, weights.ravel(), n)
        self.n_components, self.component = vertex_components(F, n)
        _, first = np.unique(self.component, return_index=True)
        held = np.zeros(n)
        held[first] = L.diagonal().mean()
        self._factor = SparseCholesky(L + sp.diags_array(held)).factor
        self._row = self._factor.permutation
        self.rows = self._row[rest.corners].ravel().astype(np.int32)
        self.pull = corner_pulls(rest, weights)
        self.centre_weights = _centre_weights(V, F, self.component)
        self.n = n

    def centres(self, V: FloatArray, out: FloatArray) -> None:
        """Find the centre of every connected piece.

        Parameters
        ----------
        V : (3 n,) ndarray
            Vertices.
        out : (pieces, 3) ndarray
            Written: mean of the vertices weighted by their areas at rest.
        """
        centres(V, self.component, self.centre_weights, out)

    def sides(self, n_frames: int) -> FloatArray:
        """Return right-hand sides of zero.

        Parameters
        ----------
        n_frames : int
            How many frames are to be solved together.

        Returns
        -------
        (n + 1, k) ndarray
            Rows in the order of the factor; frame t has the columns 3 t to 3 t + 3.
        """
        wide = 4 if n_frames == 1 else -(-3 * n_frames // 8) * 8
        return np.zeros((self.n + 1, wide))

    def solve(self, X: FloatArray, to: FloatArray, out: FloatArray) -> None:
        """Solve and put every piece in its place.

        Parameters
        ----------
        X : (n + 1, k) ndarray
            Right-hand sides as of `sides`, filled; overwritten.
        to : (pieces, 3 T) float
            Where the centres go, metres, frame after frame.
        out : (T, n, 3) ndarray
            Written: vertices, metres.
        """
        self._factor.solve_rows(X)
        write_vertices(X, self._row, self.component, self.centre_weights, to, out)


def corner_weights(rest: RestFaces) -> FloatArray:
    """Half the clamped cotangent of every corner.

    Parameters
    ----------
    rest : RestFaces
        Faces.

    Returns
    -------
    (3, m) ndarray
        Free of units.
    """
    (x, y), length = rest.apex, rest.longest
    at_apex = (x * (x - length) + y * y) / (length * y)
    return 0.5 * np.clip(np.stack([x / y, (length - x) / y, at_apex]), *COTANGENTS)


def corner_pulls(rest: RestFaces, weights: FloatArray) -> FloatArray:
    """Divergence of the undeformed faces at their second and third corner.

    Parameters
    ----------
    rest : RestFaces
        Faces.
    weights : (3, m) float
        Of their corners.

    Returns
    -------
    (4, m) ndarray
        Two vectors in the frame of the face; the first corner gets the negative of their sum.
    """
    along = np.stack([rest.longest, np.zeros(len(rest.longest))])
    across = weights[0] * (rest.apex - along)
    return np.concatenate([weights[2] * along - across, weights[1] * rest.apex + across])


def _centre_weights(V: FloatArray, F: IntArray, component: IntArray) -> FloatArray:
    areas = vertex_areas(V, F)
    # a vertex without area counts where its whole piece has none
    areas = areas + 1e-12 * areas.mean()
    return areas / np.bincount(component, areas)[component]
