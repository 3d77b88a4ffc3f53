"""A skeleton in a mesh of many pieces: where clothes hide limbs, it is sought in the body beneath."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, SkinnedMesh
from tempose.clips.mesh_parts import keep_faces
from tempose.embedding.cells import Cells
from tempose.embedding.embed import embed_in_cells, embed_skeleton
from tempose.embedding.embedding import Embedding
from tempose.embedding.heat import heat_weights
from tempose.geometry import face_components, weld
from tempose.typing import Progress, silent

_TALL, _MOST = 0.7, 3
"""A body is at least so tall a share of the whole; so many pieces are tried."""


def embed_dressed(mesh: Mesh) -> tuple[SkinnedMesh, Embedding]:
    """Place a human skeleton inside a mesh that may wear clothes, and bind the mesh to it.

    Parameters
    ----------
    mesh : Mesh
        Of one piece or many.

    Returns
    -------
    skin : SkinnedMesh
        The whole mesh with 21 joints, named by their roles, and heat weights.
    embedding : Embedding
        See `embed_whole_or_piece`.

    Raises
    ------
    ValueError
        If there is no room for a skeleton at all.
    """
    embedding, cells = embed_whole_or_piece(mesh)
    weights = heat_weights(mesh, embedding, cells=cells)
    return SkinnedMesh(mesh, embedding.skeleton, weights), embedding


def embed_whole_or_piece(mesh: Mesh, progress: Progress = silent) -> tuple[Embedding, Cells | None]:
    """Place a human skeleton inside a mesh that may wear clothes.

    Parameters
    ----------
    mesh : Mesh
        Of one piece or many.
    progress : Progress, optional
        Called after each stage.

    Returns
    -------
    embedding : Embedding
        The skeleton, of the whole; or of its one piece in which it is less doubtful, where the whole is
        doubtful.
    cells : Cells or None
        The inside in which the whole was read; None where a piece was better.

    Raises
    ------
    ValueError
        If there is no room for a skeleton at all.
    """
    whole, cells = embed_in_cells(mesh, None, progress)
    if not whole.doubtful:
        return whole, cells
    best = whole
    for part in _tall_pieces(mesh):
        found = embed_skeleton(part)
        if found.penalty < best.penalty:
            best = found
    return best, (cells if best is whole else None)


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
