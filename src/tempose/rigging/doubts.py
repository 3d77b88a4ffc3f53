"""What is said of a rig that does not belong to its clip."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh

_FAR = 5.0
"""Percent of the diagonal, rms. Rigs of dressed people leave 1 to 3; a skin on wrong vertices 7 and more."""


def doubts_of_skin(rms_percent: float) -> list[str]:
    """Say when a skin follows its clip so badly that it can hardly be the clip's.

    Parameters
    ----------
    rms_percent : float
        Error of the skin alone over all frames, rms, in percent of the diagonal.

    Returns
    -------
    list of str
        A sentence, or nothing where the skin follows.
    """
    if rms_percent <= _FAR:
        return []
    return [
        f"the skin alone is off by {rms_percent:.3g} % of the diagonal (rms), where rigs that belong to "
        f"their clip are off by less than {_FAR:g} %: weights, skeleton or order of vertices may be those "
        "of another mesh"
    ]


def doubts_of_faces(mesh: Mesh, other: Mesh, name: str) -> list[str]:
    """Say when a mesh has the vertices of a rig in number, but other faces.

    Parameters
    ----------
    mesh : Mesh
        Of the rig.
    other : Mesh
        Of a clip with as many vertices.
    name : str
        What the clip is called.

    Returns
    -------
    list of str
        A sentence, or nothing where faces join the same vertices.
    """
    if _joined(mesh) == _joined(other):
        return []
    return [
        f"{name} has as many vertices as the rig but other faces: its vertices are taken to come "
        "in the same order"
    ]


def _joined(mesh: Mesh) -> bytes:
    """Return the faces as sets of vertices: whichever way they turn, in whatever order."""
    faces = np.sort(mesh.faces, axis=1)
    return faces[np.lexsort(faces.T)].astype(np.int64).tobytes()
