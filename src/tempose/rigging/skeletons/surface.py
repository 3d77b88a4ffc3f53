"""What is unusual about a surface that is to be rigged."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh
from tempose.geometry import boundary_edges, face_areas, face_components, weld


def surface_warnings(mesh: Mesh) -> tuple[str, ...]:
    """Say whether a mesh is open, in pieces or inside out.

    Parameters
    ----------
    mesh : Mesh
        Any mesh.

    Returns
    -------
    tuple of str
        One sentence each; empty for a closed surface of one piece.
    """
    first, inverse = weld(mesh.vertices)
    V, F = mesh.vertices[first], inverse[mesh.faces]
    edges, pieces = len(boundary_edges(F)), face_components(F, len(V))[0] if len(F) else 0
    said: list[str] = []
    if edges:
        said.append(
            f"the surface is open: {edges} edges have a face on one side only; "
            "the inside was closed over the holes"
        )
    if pieces > 1:
        said.append(
            f"the surface is in {pieces} pieces; what lies inside any of them counts as inside, "
            "and pieces that see no bone take the weights of their nearest neighbour"
        )
    if len(F) and enclosed_volume(mesh) < -_INSIDE_OUT * float(face_areas(V, F).sum()) ** 1.5:
        said.append("the surface is inside out: its faces turn clockwise seen from outside; used as it is")
    return tuple(said)


_INSIDE_OUT = 1e-4


def enclosed_volume(mesh: Mesh) -> float:
    """Signed volume that a surface encloses.

    Parameters
    ----------
    mesh : Mesh
        Any mesh; holes count as closed towards the centroid.

    Returns
    -------
    float
        Cubic metres; negative where faces turn clockwise seen from outside.
    """
    a, b, c = (mesh.vertices[mesh.faces[:, k]] - mesh.vertices.mean(axis=0) for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)
