"""What of a target does not depend on its marks: made once, though pairs change again and again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.clips import Mesh
from tempose.geometry import cotangent_laplacian, edge_laplacian, weld
from tempose.linalg.ordering import nested_dissection
from tempose.transfer.solver.links import ExtraEdges, link_pieces, shell_edges
from tempose.typing import FloatArray, IntArray

_TRACE = 1e-7


@dataclass(frozen=True)
class Fabric:
    """A target welded and linked, with the matrix of its harmonic fields."""

    mesh: Mesh
    """The target."""
    first: IntArray
    """(u,) int, first vertex at each distinct position."""
    inverse: IntArray
    """(n,) int, place of each vertex among them."""
    V: FloatArray
    """(u, 3) metres."""
    F: IntArray
    """(m, 3) int, faces of the welded mesh."""
    links: ExtraEdges
    """Edges between its pieces."""
    shell: ExtraEdges
    """Edges between the two sides of thin cloth."""
    field_matrix: Any
    """(u, u) sparse Laplacian with weights that are not negative, one component."""
    order: IntArray
    """Order of elimination, of `field_matrix` with the shell."""


def weave(mesh: Mesh) -> Fabric:
    """Weld, link and order a target.

    Parameters
    ----------
    mesh : Mesh
        Target at rest.

    Returns
    -------
    Fabric
        Can be shared by all solvers of this mesh.
    """
    first, inverse = weld(mesh.vertices)
    V, F = mesh.vertices[first], inverse[mesh.faces]
    links = link_pieces(V, F)
    matrix = field_laplacian(V, F, links)
    shell = shell_edges(V, F)
    # one order serves the fields and the glue
    order = nested_dissection(matrix + edge_laplacian(shell.pairs, shell.weights, len(V)))
    return Fabric(mesh, first, inverse, V, F, links, shell, matrix, order)


def field_laplacian(V: FloatArray, F: IntArray, links: ExtraEdges) -> Any:
    """Laplacian of harmonic fields: weights that are not negative, pieces linked, no vertex without hold.

    Parameters
    ----------
    V : (u, 3) float
        Vertices, welded.
    F : (m, 3) int
        Faces, all of the mesh or a part of it.
    links : ExtraEdges
        Edges between its pieces.

    Returns
    -------
    (u, u) scipy.sparse.csr_array
        Positive semidefinite.
    """
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    # clamped weights may leave a vertex without any: a trace of the graph Laplacian keeps it attached
    return (
        cotangent_laplacian(V, F, clamp=True)
        + edge_laplacian(links.pairs, links.weights, len(V))
        + edge_laplacian(edges, np.full(len(edges), _TRACE), len(V))
    )
