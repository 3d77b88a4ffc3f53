"""Laplacians and mass matrices: positive semidefinite, weak form."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import scipy.sparse as sp

from tempose.geometry.normals import face_areas, vertex_areas
from tempose.typing import FloatArray, IntArray


def cotangents(V: FloatArray, F: IntArray, limit: float = 1e4) -> FloatArray:
    """Half cotangent of the angle at every corner: the weight of the edge opposite to it.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces; degenerate ones get weight 0.
    limit : float, default 1e4
        Largest absolute value, so that a sliver cannot spoil the conditioning.

    Returns
    -------
    (m, 3) ndarray
        ``cot(angle at corner k) / 2``, which belongs to the edge ``(F[:, k+1], F[:, k+2])``.
    """
    V = np.asarray(V, dtype=np.float64)
    a, b, c = (V[F[:, k]] for k in range(3))
    opposite = (c - b, a - c, b - a)
    longest = np.max([_dots(e, e) for e in opposite], axis=0, initial=0.0)
    normals = np.cross(opposite[1], opposite[2])
    double_area = np.sqrt(_dots(normals, normals))
    fine = double_area > 1e-12 * longest
    half = np.zeros(F.shape)
    for k in range(3):
        dots = _dots(opposite[(k + 1) % 3], opposite[(k + 2) % 3])
        np.divide(-0.5 * dots, double_area, out=half[:, k], where=fine)
    return np.clip(half, -limit, limit)


def _dots(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.einsum("mc,mc->m", x, y)


def edge_laplacian(edges: IntArray, weights: FloatArray, n: int) -> Any:
    """Graph Laplacian of weighted edges.

    Parameters
    ----------
    edges : (e, 2) int
        Vertex pairs; repeated pairs add up.
    weights : (e,) float
        Weight of each.
    n : int
        Number of vertices.

    Returns
    -------
    (n, n) scipy.sparse.csr_array
        Symmetric; rows sum to 0; positive semidefinite where the weights are a sum of element energies.
    """
    i, j = np.asarray(edges).reshape(-1, 2).T
    off = sp.coo_array((np.concatenate([weights, weights]), (np.r_[i, j], np.r_[j, i])), shape=(n, n)).tocsr()
    return (sp.diags_array(np.asarray(off.sum(axis=1)).ravel()) - off).tocsr()


def cotangent_laplacian(V: FloatArray, F: IntArray, *, clamp: bool = False) -> Any:
    """(pos. semidef.) cotangent Laplacian, assembled face by face, so that any face set will do.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces; duplicated, non-manifold and degenerate ones do no harm.
    clamp : bool, default False
        Whether negative edge weights become 0, which gives harmonic functions a maximum principle.

    Returns
    -------
    (n, n) scipy.sparse.csr_array
        ``L 1 = 0``; free of units.

    Notes
    -----
    The opposite sign of libigl's ``cotmatrix``.
    """
    n = len(V)
    half = cotangents(V, F)
    edges = np.concatenate([F[:, [1, 2]], F[:, [2, 0]], F[:, [0, 1]]])
    weights = half.T.ravel()
    if clamp:
        low, high = edges.min(axis=1), edges.max(axis=1)
        summed = sp.coo_array((weights, (low, high)), shape=(n, n)).tocsr().tocoo()
        edges = np.column_stack([summed.row, summed.col])
        weights = np.maximum(summed.data, 0.0)
    return edge_laplacian(edges, weights, n)


def mass_matrix(V: FloatArray, F: IntArray, kind: Literal["lumped", "full"] = "lumped") -> Any:
    """Mass matrix of piecewise linear functions.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    kind : {"lumped", "full"}, default "lumped"
        Diagonal (third of the areas round a vertex), or consistent.

    Returns
    -------
    (n, n) scipy.sparse array
        Units of area; all entries sum to the area of the mesh.
    """
    if kind == "lumped":
        return sp.diags_array(vertex_areas(V, F)).tocsr()
    areas = face_areas(V, F)
    rows = np.concatenate([F[:, i] for i in range(3) for _ in range(3)])
    columns = np.concatenate([F[:, j] for _ in range(3) for j in range(3)])
    values = np.concatenate([areas / (6 if i == j else 12) for i in range(3) for j in range(3)])
    return sp.coo_array((values, (rows, columns)), shape=(len(V), len(V))).tocsr()
