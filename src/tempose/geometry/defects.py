"""What is wrong with a mesh, counted."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from tempose.geometry.normals import face_areas
from tempose.geometry.topology import face_components
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Defects:
    """Counts of what a clean closed mesh has none of, and of its connected pieces."""

    pieces: int
    """Connected pieces that have faces; faces that share a vertex hang together."""
    boundary_edges: int
    """Edges of one face only."""
    nonmanifold_edges: int
    """Edges of more than two faces."""
    degenerate_faces: int
    """Faces that name a vertex twice or whose area is below 1e-12 of the squared diagonal."""
    duplicate_faces: int
    """Faces with the same three vertices as an earlier one, in any order."""
    loose_vertices: int
    """Vertices that no face uses."""

    def as_dict(self) -> dict[str, int]:
        """Return the counts by name.

        Returns
        -------
        dict
            One entry a field.
        """
        return asdict(self)


def find_defects(V: FloatArray, F: IntArray) -> Defects:
    """Count the defects of a mesh.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.

    Returns
    -------
    Defects
        All zero but `pieces` for a clean closed mesh.
    """
    n = len(V)
    if len(F) == 0:
        return Defects(0, 0, 0, 0, 0, n)
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    sharing = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0, return_counts=True)[1]
    corners = np.sort(F, axis=1)
    repeated = (corners[:, 1:] == corners[:, :-1]).any(axis=1)
    D = float(np.linalg.norm(np.ptp(V, axis=0)))
    flat = face_areas(V, F) <= 1e-12 * D * D
    return Defects(
        pieces=face_components(F, n)[0],
        boundary_edges=int((sharing == 1).sum()),
        nonmanifold_edges=int((sharing > 2).sum()),
        degenerate_faces=int((repeated | flat).sum()),
        duplicate_faces=len(F) - len(np.unique(corners, axis=0)),
        loose_vertices=n - len(np.unique(F)),
    )
