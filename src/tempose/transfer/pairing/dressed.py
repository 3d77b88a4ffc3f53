"""A skeleton in a target of many pieces: where clothes hide limbs, it is sought in the body beneath."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, SkinnedMesh
from tempose.clips.mesh_parts import keep_faces
from tempose.embedding import Embedding, embed_skeleton, embed_skin, heat_weights
from tempose.geometry import face_components, weld

_TALL, _MOST = 0.7, 3
"""A body is at least so tall a share of the whole; so many pieces are tried."""


def embed_dressed(mesh: Mesh) -> tuple[SkinnedMesh, Embedding]:
    """Place a human skeleton inside a target that may wear clothes.

    Parameters
    ----------
    mesh : Mesh
        Target, of one piece or many.

    Returns
    -------
    skin : SkinnedMesh
        The whole target bound to the skeleton.
    embedding : Embedding
        The skeleton, of the whole; or of its one piece in which it is less doubtful, where the whole is
        doubtful.

    Raises
    ------
    ValueError
        If there is no room for a skeleton at all.
    """
    skin, best = embed_skin(mesh)
    if not best.doubtful:
        return skin, best
    whole = best
    for part in _tall_pieces(mesh):
        found = embed_skeleton(part)
        if found.penalty < best.penalty:
            best = found
    if best is not whole:
        skin = SkinnedMesh(mesh, best.skeleton, heat_weights(mesh, best))
    return skin, best


def _tall_pieces(mesh: Mesh) -> list[Mesh]:
    """Pieces nearly as large as the whole, those of most faces first."""
    first, inverse = weld(mesh.vertices)
    count, piece = face_components(inverse[mesh.faces], len(first))
    if count < 2:
        return []
    size = float(np.ptp(mesh.vertices, axis=0).max())
    parts: list[Mesh] = []
    for label in np.argsort(-np.bincount(piece), kind="stable")[:_MOST]:
        part = keep_faces(mesh, piece == label)[0]
        if float(np.ptp(part.vertices, axis=0).max()) > _TALL * size:
            parts.append(part)
    return parts
