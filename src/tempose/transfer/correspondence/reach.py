"""How far places of the target lie from the nearest mark."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, dijkstra

from tempose.clips import Mesh
from tempose.geometry import edge_list, face_components, weld
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.solver.links import link_pieces
from tempose.typing import FloatArray, IntArray

_SMALLEST = 0.002


def mark_distances(mesh: Mesh, pairs: Pairs) -> tuple[FloatArray, IntArray]:
    """Way along the surface to the nearest mark, over the links between pieces where there are several.

    Parameters
    ----------
    mesh : Mesh
        Target at rest.
    pairs : Pairs
        Its marks.

    Returns
    -------
    distance : (m,) ndarray
        From each face, metres.
    nearest : (m,) ndarray of int
        Which pair that is.
    """
    first, inverse = weld(mesh.vertices)
    V, F = mesh.vertices[first], inverse[mesh.faces]
    links = link_pieces(V, F).pairs
    edges = np.concatenate([edge_list(F), links.reshape(-1, 2)])
    lengths = np.linalg.norm(V[edges[:, 0]] - V[edges[:, 1]], axis=1) + 1e-12
    graph: Any = sp.coo_array((lengths, (edges[:, 0], edges[:, 1])), shape=(len(V), len(V))).tocsr()
    if pairs.kind == "vertices":
        marked, row = inverse[pairs.target], np.arange(len(pairs))
    else:
        marked, row = F[pairs.target].ravel(), np.repeat(np.arange(len(pairs)), 3)
    owner = np.zeros(len(V), dtype=np.int64)
    owner[marked] = row
    distance, _, origin = dijkstra(
        graph, directed=False, indices=np.unique(marked), min_only=True, return_predecessors=True
    )
    of_face = F[np.arange(len(F)), distance[F].argmin(axis=1)]
    return distance[of_face], owner[np.maximum(origin[of_face], 0)]


def far_regions(mesh: Mesh, distance: FloatArray, far: float) -> list[IntArray]:
    """Gather the connected regions that lie far from every mark.

    Parameters
    ----------
    mesh : Mesh
        Target at rest.
    distance : (m,) float
        From `mark_distances`.
    far : float
        Share of the diagonal.

    Returns
    -------
    list of (k,) ndarray of int
        Faces, the largest region first; specks are left out.
    """
    mine = np.flatnonzero(distance > far * mesh.diagonal)
    if len(mine) == 0:
        return []
    F = weld(mesh.vertices)[1][mesh.faces[mine]]
    rows = np.repeat(np.arange(len(mine)), 3)
    joins: Any = sp.coo_array((np.ones(len(rows)), (rows, F.ravel())), shape=(len(mine), int(F.max()) + 1))
    joins = joins.tocsr()
    labels = connected_components(joins @ joins.T, directed=False)[1]
    regions = [mine[labels == label] for label in range(int(labels.max()) + 1)]
    regions = [region for region in regions if len(region) > _SMALLEST * len(mesh.faces)]
    return sorted(regions, key=len, reverse=True)


def name_place(mesh: Mesh, pairs: Pairs, face: int, nearest: int) -> str:
    """Say in words where a face is.

    Parameters
    ----------
    mesh : Mesh
        Target at rest, upright, left side towards +X.
    pairs : Pairs
        Pairs with names.
    face : int
        The face.
    nearest : int
        The pair nearest to it.

    Returns
    -------
    str
        Such as ``"beyond left_forearm (left, at 62 % of the height)"``.
    """
    P = mesh.vertices[mesh.faces[face]].mean(axis=0)
    low, size = mesh.vertices.min(axis=0), np.maximum(np.ptp(mesh.vertices, axis=0), 1e-300)
    share = (P - low) / size
    side = "left" if share[0] > 0.6 else "right" if share[0] < 0.4 else "middle"
    name = pairs.parts[nearest] if pairs.parts else ""
    if not name:
        name = str(pairs.source[nearest]) if pairs.kind == "joints" else f"pair {nearest}"
    return f"beyond {name} ({side}, at {100 * share[1]:.0f} % of the height)"


def face_pieces(mesh: Mesh) -> IntArray:
    """Label the connected piece of every face, texture seams closed.

    Parameters
    ----------
    mesh : Mesh
        Any mesh.

    Returns
    -------
    (m,) ndarray of int
        From 0.
    """
    first, inverse = weld(mesh.vertices)
    return face_components(inverse[mesh.faces], len(first))[1]
