"""A deforming mesh moves another: rotations read off its surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import (
    breadth_first_order,
    connected_components,
    dijkstra,
    minimum_spanning_tree,
)

from tempose.clips import Mesh, MeshClip
from tempose.geometry import edge_list, k_rings
from tempose.transfer.feet.mesh_feet import mesh_feet
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.solver.fabric import Fabric
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.transfer.turns.mesh_source import RINGS, face_patches, patch_rotations, vertex_patches
from tempose.transfer.turns.signs import consistent_signs
from tempose.typing import FloatArray, IntArray

MANY_PAIRS = 2000
"""From so many on, marks are dense: each face then gives its own rotation instead of its neighbourhood's."""


def prepare_mesh(
    clip: MeshClip,
    mesh: Mesh,
    pairs: Pairs,
    *,
    rest: FloatArray | None = None,
    volume: float = 0.0,
    fabric: Fabric | None = None,
) -> Prepared:
    """Do everything that comes before the frames.

    Parameters
    ----------
    clip : MeshClip
        Source.
    mesh : Mesh
        Target at rest, in a pose like the source's reference.
    pairs : Pairs
        Of kind ``"vertices"`` or ``"faces"``, checked.
    rest : (n, 3) float, optional
        Reference pose of the source in any scale; the rest of the clip if not given.
    volume : float, default 0
        See `MotionTransfer`.
    fabric : Fabric, optional
        See `MotionTransfer`.

    Returns
    -------
    Prepared
        Solver, rotations and paths.
    """
    F, n = clip.faces, clip.vertices.shape[1]
    V_rest = clip.rest if rest is None else _in_scale_of(clip, rest)
    source = np.asarray(pairs.source)
    if pairs.kind == "vertices":
        patches, middle = vertex_patches(F, n, source), source
        marked, columns = _target_rings(mesh, pairs.target)
    else:
        patches = face_patches(F, n, source, RINGS if len(pairs) < MANY_PAIRS else 0)
        middle = F[source, 0]
        marked, columns = mesh.faces[pairs.target].ravel(), np.repeat(np.arange(len(pairs)), 3)
    # frames are kept in float32
    solver = MotionTransfer(
        mesh, marked, columns, len(pairs), volume=volume, precision="single", fabric=fabric
    )
    raw = patch_rotations(clip.vertices, V_rest, F, patches)
    order, parents = geodesic_tree(V_rest, F, middle)
    Q = np.zeros_like(raw)
    Q[:, order] = consistent_signs(raw[:, order], parents)
    centroid = np.asarray(clip.vertices[:, middle], dtype=np.float64).mean(axis=1)
    partner = pairs.target if pairs.kind == "vertices" else mesh.faces[pairs.target, 0]
    feet = mesh_feet(clip.vertices, V_rest, middle, mesh.vertices, mesh.faces, partner, clip.fps)
    basis = solver.basis
    owner = np.zeros(len(mesh.vertices), dtype=np.int64) if basis is None else basis.argmax(axis=1)
    return Prepared(
        solver,
        Q,
        centroid - V_rest[middle].mean(axis=0),
        feet,
        _size_ratio(V_rest[middle], mesh.vertices[partner]),
        float(np.ptp(V_rest[:, 1])),
        owner,
        chosen="rest of the clip" if rest is None else "source_rest",
    )


def _in_scale_of(clip: MeshClip, rest: FloatArray) -> FloatArray:
    """Scale a reference mesh to the clip: the same animal is often stored in two sizes."""
    edges = edge_list(clip.faces)

    def lengths(V: FloatArray) -> FloatArray:
        return np.linalg.norm(V[edges[:, 0]] - V[edges[:, 1]], axis=1)

    now, then = lengths(np.asarray(clip.vertices[0], dtype=np.float64)), lengths(rest)
    ratio = float(np.median(now[then > 0] / then[then > 0]))
    return rest * ratio if abs(np.log(ratio)) > 0.01 else rest


def _target_rings(mesh: Mesh, vertices: IntArray) -> tuple[IntArray, IntArray]:
    """Mark the one-ring of a vertex: a single one is a logarithmic spike of a harmonic function."""
    rings = k_rings(mesh.faces, len(mesh.vertices), vertices, 1)
    return np.concatenate(rings), np.repeat(np.arange(len(vertices)), [len(r) for r in rings])


def _size_ratio(source: FloatArray, target: FloatArray) -> float:
    spread = np.linalg.norm(source - source.mean(axis=0))
    return float(np.linalg.norm(target - target.mean(axis=0)) / spread) if spread > 0 else 1.0


def geodesic_tree(V: FloatArray, F: IntArray, vertices: IntArray) -> tuple[IntArray, IntArray]:
    """Tree between marks by distance along the surface, so that left and right legs are no neighbours.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    vertices : (k,) int
        Marked vertices.

    Returns
    -------
    order : (k,) ndarray of int
        Marks, parents first.
    parents : (k,) ndarray of int
        Place of each one's parent within `order`, -1 at the root.
    """
    i, j = edge_list(F).T
    length = np.linalg.norm(V[i] - V[j], axis=1) + 1e-12
    graph: Any = sp.coo_array((length, (i, j)), shape=(len(V), len(V))).tocsr()
    k = len(vertices)
    if k <= MANY_PAIRS:
        between = dijkstra(graph, directed=False, indices=vertices)[:, vertices]
        far = 10 * float(np.linalg.norm(np.ptp(V, axis=0)))
        between = np.where(np.isfinite(between), between, far) + 1e-9
        tree: Any = minimum_spanning_tree(np.triu(between, 1))
        return _walk(tree, k)
    # many marks: the spanning tree of the mesh itself, pulled back to its marked vertices
    at = np.full(len(V), -1, dtype=np.int64)
    at[vertices] = np.arange(k)
    order, parents = _walk(minimum_spanning_tree(graph), len(V), int(vertices[0]))
    return _pull_back(order, parents, at, vertices)


def _walk(tree: Any, k: int, root: int = 0) -> tuple[IntArray, IntArray]:
    """Order a forest of k nodes parents first; trees without the root hang on it by one node each."""
    labels = connected_components(tree, directed=False)[1]
    first = np.unique(labels, return_index=True)[1]
    apart = first[labels[first] != labels[root]]
    rope: Any = sp.coo_array((np.ones(len(apart)), (np.full(len(apart), root), apart)), shape=(k, k))
    order, above = breadth_first_order(tree + rope.tocsr(), root, directed=False)
    place = np.zeros(k, dtype=np.int64)
    place[order] = np.arange(k)
    above = above[order]
    return order, np.where(above >= 0, place[np.maximum(above, 0)], -1)


def _pull_back(
    order: IntArray, parents: IntArray, at: IntArray, vertices: IntArray
) -> tuple[IntArray, IntArray]:
    """Restrict a tree of vertices to marks; several marks on one vertex hang on the first of them."""
    nearest = np.full(len(order), -1, dtype=np.int64)
    ranked: list[int] = []
    above: list[int] = []
    for i, v in enumerate(order):
        inherited = nearest[parents[i]] if parents[i] >= 0 else -1
        if at[v] >= 0:
            nearest[i] = len(ranked)
            ranked.append(int(at[v]))
            above.append(int(inherited))
        else:
            nearest[i] = inherited
    place = {mark: r for r, mark in enumerate(ranked)}
    for mark in range(len(vertices)):
        if mark not in place:
            above.append(place[int(at[vertices[mark]])])
            ranked.append(mark)
    return np.array(ranked), np.array(above)
