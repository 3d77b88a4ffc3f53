"""Edges of one mesh collapsed by their quadric error, recorded so that every frame collapses alike."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from tempose._validate import as_floats, as_indices
from tempose.geometry.normals import face_areas, face_normals
from tempose.geometry.topology import boundary_edges, edge_list
from tempose.typing import FloatArray, IntArray

_ROUND = 0.1
"""Weight of the places of vertices beside that of their planes: spreads what is left over flat and round
parts alike, which bend later; residuals carried up from 5 % of the crane are a tenth nearer."""
_RIM = 10.0
"""Weight of the planes that stand on open edges, which keep the rim where it is."""


@dataclass(frozen=True, eq=False)
class Collapses:
    """What was collapsed, in order: replaying it moves no decision, only vertices."""

    pairs: IntArray
    """(c, 2) vertex that stayed, vertex that went into it."""
    shares: FloatArray
    """(c,) how far the one that stayed moved towards the one that went, 0 to 1."""
    kept: IntArray
    """(K,) vertices of the full mesh that are left, ascending."""
    faces: IntArray
    """(k, 3) int32 faces over the K vertices."""
    n_vertices: int
    """n of the full mesh."""

    @cached_property
    def matrix(self) -> csr_matrix:
        """(K, n) the whole sequence as one linear map; rows sum to 1, no column holds more than one entry.

        A collapse puts ``(1 - s) v_a + s v_b`` in the place of two vertices whose sources are disjoint, so
        the factors of all sources follow from the last collapse backwards.
        """
        owner, weight = np.arange(self.n_vertices), np.ones(self.n_vertices)
        for (a, b), s in zip(self.pairs[::-1].tolist(), self.shares[::-1].tolist()):
            owner[b], weight[b] = owner[a], s * weight[a]
            weight[a] *= 1.0 - s
        rows = np.minimum(np.searchsorted(self.kept, owner), len(self.kept) - 1)
        used = np.flatnonzero(self.kept[rows] == owner)  # a vertex without a face went nowhere
        shape = (len(self.kept), self.n_vertices)
        return csr_matrix((weight[used], (rows[used], used)), shape)

    def replay(self, V: FloatArray) -> FloatArray:
        """Collapse frames of the same mesh.

        Parameters
        ----------
        V : (..., n, 3) float
            Frames, or anything else that is given at the vertices.

        Returns
        -------
        (..., K, 3) ndarray
            The same on the vertices that are left.
        """
        if V.ndim == 2:
            return self.matrix @ V
        return np.stack([self.replay(frame) for frame in V])


def collapse_edges(V: FloatArray, F: IntArray, count: int) -> Collapses:
    """Collapse edges of a mesh until few vertices are left.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, in any unit.
    F : (m, 3) int
        Faces.
    count : int
        Wanted number of vertices; more are left where nothing can be collapsed without tearing or folding.

    Returns
    -------
    Collapses
        The sequence.

    Raises
    ------
    ValueError
        If `count` is below 4 or above n, or no face has an area.

    Notes
    -----
    Cheapest edge first by the quadric error of [1]_; the place is the best one on the edge itself, so that it
    is a mixture of two vertices in every frame: the best place in space would have to be found anew for each
    frame, and would tremble where the surface is flat.

    References
    ----------
    .. [1] Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997.
    """
    from tempose.geometry._collapse_kernel import record_collapses  # numba loads slowly, few need it

    V = as_floats(V, "V", ("n", 3))
    F = as_indices(F, "F", ("m", 3), limit=len(V))
    if not 4 <= count <= len(V):
        raise ValueError(f"count must be from 4 to the {len(V)} vertices of the mesh, got {count}")
    areas = face_areas(V, F)
    if not areas.sum() > 0:
        raise ValueError("V and F must hold a face with an area, found none")
    # unit size: costs of another unit must not reorder edges by rounding
    P = V - V.mean(axis=0)
    P /= np.sqrt(np.square(P).sum(axis=1).mean())
    rim = boundary_edges(F)
    Q = _quadrics(P, F, rim)
    on_rim = np.zeros(len(V), dtype=np.bool_)
    on_rim[rim.ravel()] = True
    edges = np.sort(edge_list(F), axis=1).astype(np.int64)
    pairs, shares, left, alive = record_collapses(P.copy(), F.astype(np.int64), edges, Q, on_rim, count)
    kept = np.flatnonzero(alive)
    faces = np.searchsorted(kept, left).astype(np.int32)
    return Collapses(pairs, shares, kept, faces, len(V))


def _quadrics(P: FloatArray, F: IntArray, rim: IntArray) -> FloatArray:
    """(n, 4, 4) squared distances to the planes of the faces round each vertex, by area."""
    n, areas, normals = len(P), face_areas(P, F), face_normals(P, F)
    Q = np.zeros((n, 4, 4))
    planes = np.column_stack([normals, -(normals * P[F[:, 0]]).sum(axis=1)])
    K = areas[:, None, None] / 3 * planes[:, :, None] * planes[:, None, :]
    for c in range(3):
        np.add.at(Q, F[:, c], K)
    _stand_on_rim(Q, P, F, normals, rim)
    own = np.zeros(n)
    np.add.at(own, F.ravel(), np.repeat(areas / 3, 3))
    point = np.zeros((n, 4, 4))
    point[:, :3, :3] = np.eye(3)
    point[:, :3, 3] = point[:, 3, :3] = -P
    point[:, 3, 3] = (P**2).sum(axis=1)
    return Q + _ROUND * own[:, None, None] * point


def _stand_on_rim(Q: FloatArray, P: FloatArray, F: IntArray, normals: FloatArray, rim: IntArray) -> None:
    a, b = F.T.ravel().astype(np.int64), np.roll(F, -1, axis=1).T.ravel().astype(np.int64)
    n = len(P)
    is_open = np.isin(a * n + b, rim[:, 0].astype(np.int64) * n + rim[:, 1])
    a, b, N = a[is_open], b[is_open], np.tile(normals, (3, 1))[is_open]
    along = P[b] - P[a]
    across = np.cross(along, N)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    across = np.divide(across, length, out=np.zeros_like(across), where=length > 0)
    planes = np.column_stack([across, -(across * P[a]).sum(axis=1)])
    weight = _RIM * (along**2).sum(axis=1)
    K = weight[:, None, None] * planes[:, :, None] * planes[:, None, :]
    np.add.at(Q, a, K)
    np.add.at(Q, b, K)
