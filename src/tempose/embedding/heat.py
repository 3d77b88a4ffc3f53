"""Heat-equilibrium weights (Baran and Popovic 2007, section 4)."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.spatial import KDTree

from tempose._validate import as_floats
from tempose.clips import Mesh, Skeleton
from tempose.embedding._sight import sees
from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.embedding import Embedding
from tempose.embedding.segments import bone_segments, nearest_on_segments
from tempose.embedding.solid import make_solid
from tempose.geometry import (
    cotangent_laplacian,
    edge_laplacian,
    edge_list,
    vertex_areas,
    vertex_components,
    weld,
)
from tempose.linalg import SparseCholesky
from tempose.typing import BoolArray, FloatArray, IntArray

_TRIED = 4
_TIE = 1e-6
_LEAST_DISTANCE = 1e-3
_LEAST_CONDUCTANCE = 1e-6


def heat_weights(mesh: Mesh, bones: Embedding | Skeleton | Any, *, cells: Cells | None = None) -> FloatArray:
    """Weights of bones on vertices, as heat that flows from the bones through the surface.

    Parameters
    ----------
    mesh : Mesh
        n vertices; several pieces, holes and duplicate vertices are allowed.
    bones : Embedding, Skeleton or (B, 2, 3) float
        An embedded skeleton, any skeleton inside the mesh, or the ends of B bones.
    cells : Cells, optional
        The inside of the mesh, if already known.

    Returns
    -------
    (n, B) ndarray
        Rows >= 0 that sum to 1; a column a joint of the skeleton.

    Raises
    ------
    ValueError
        If the mesh encloses nothing, or no bone is seen from any vertex.

    Notes
    -----
    Solves ``(L + M H) w = M H p`` a bone, L the cotangent Laplacian, M vertex areas, p = 1 where the bone is
    the nearest one seen from the vertex, ``H = 1 / d^2`` with the distance d to it [1]_. Pieces from which
    no bone is seen, such as clothes over a body, take the weights of the nearest other surface.

    References
    ----------
    .. [1] Baran and Popovic, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007.
    """
    if isinstance(bones, Embedding):
        bones = bones.skeleton
    segments = bone_segments(bones) if isinstance(bones, Skeleton) else as_floats(bones, "bones", ("B", 2, 3))
    first, inverse = weld(mesh.vertices)
    V, F = mesh.vertices[first], inverse[mesh.faces]
    F = F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])]
    if cells is None:
        solid = make_solid(V, F)
        cells = make_cells(solid, solid.walls) or make_cells(solid, None)
        assert cells is not None
    share, distance = nearest_seen(V, segments, cells)
    return _equilibrium(V, F, share, distance, mesh.diagonal)[inverse]


def nearest_seen(V: FloatArray, segments: FloatArray, cells: Cells) -> tuple[FloatArray, FloatArray]:
    """Nearest bone that is seen from each vertex.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    segments : (B, 2, 3) float
        Bones.
    cells : Cells
        The inside of the mesh.

    Returns
    -------
    share : (n, B) ndarray
        1 for the nearest seen among the four nearest bones, shared where several are as near, as at a
        joint; a row of zeros where none is seen.
    distance : (n,) ndarray
        How far it is.
    """
    solid = cells.solid
    walls = np.zeros((3, 1, 1, 1), dtype=np.bool_) if cells.walls is None else cells.walls
    nearest, distances = nearest_on_segments(V, segments)
    order = np.argsort(distances, axis=1)[:, :_TRIED]
    bone = np.full(len(V), -1)
    rows = np.arange(len(V))
    for rank in range(order.shape[1]):
        open_ = np.flatnonzero(bone < 0)
        b = order[open_, rank]
        starts = (nearest[open_, b] - solid.origin) / solid.spacing
        ends = (V[open_] - solid.origin) / solid.spacing
        seen = sees(solid.inside, walls, cells.walls is not None, starts, ends)
        bone[open_[seen]] = b[seen]
    distance = distances[rows, np.maximum(bone, 0)]
    share = ((distances <= (1 + _TIE) * distance[:, None]) & (bone >= 0)[:, None]).astype(np.float64)
    # what is nearer than the nearest seen is not seen itself
    share[distances < (1 - _TIE) * distance[:, None]] = 0.0
    return share / np.maximum(share.sum(axis=1, keepdims=True), 1.0), distance


def _equilibrium(
    V: FloatArray, F: IntArray, share: FloatArray, distance: FloatArray, diagonal: float
) -> FloatArray:
    heated = share.sum(axis=1) > 0
    reached = _reached(V, F, heated)
    if not reached.any():
        raise ValueError("no bone is seen from any vertex; the skeleton lies outside the mesh")
    # a bone that touches the surface would hold the vertex with infinite force
    heat = np.where(heated, 1.0 / np.maximum(distance, _LEAST_DISTANCE * diagonal) ** 2, 0.0)
    heat = heat * vertex_areas(V, F)
    rows = np.flatnonzero(reached)
    # clamped cotangents keep every weight between 0 and 1
    L = cotangent_laplacian(V, F, clamp=True)
    # and a little of the graph keeps vertices joined that clamping has cut off
    edges = edge_list(F)
    L = L + edge_laplacian(edges, np.full(len(edges), _LEAST_CONDUCTANCE), len(V))
    A = (L + sp.diags_array(heat)).tocsr()[rows][:, rows]
    weights = np.zeros(share.shape)
    weights[rows] = np.maximum(SparseCholesky(A).solve((heat[:, None] * share)[rows]), 0.0)
    rest = np.flatnonzero(~reached)
    if len(rest):
        weights[rest] = weights[rows[KDTree(V[rows]).query(V[rest])[1]]]
    return weights / weights.sum(axis=1, keepdims=True)


def _reached(V: FloatArray, F: IntArray, heated: BoolArray) -> BoolArray:
    """Vertices joined by edges to enough that is heated."""
    count, labels = vertex_components(F, len(V))
    used = np.zeros(len(V), dtype=np.bool_)
    used[F] = True
    warm = np.bincount(labels, heated & used, minlength=count)
    size = np.bincount(labels, minlength=count)
    return (warm > 0.05 * size)[labels] & used
