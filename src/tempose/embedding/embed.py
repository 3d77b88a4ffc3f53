"""The whole way from a mesh to a skeleton inside it."""

from __future__ import annotations

from tempose.clips import Mesh, SkinnedMesh
from tempose.embedding.embedding import Embedding
from tempose.embedding.heat import heat_weights
from tempose.typing import Progress, silent


def embed_skeleton(mesh: Mesh, *, up: str | None = None, progress: Progress = silent) -> Embedding:
    """Place a human skeleton of 18 joints inside a mesh."""
    raise NotImplementedError


def embed_skin(
    mesh: Mesh, *, up: str | None = None, progress: Progress = silent
) -> tuple[SkinnedMesh, Embedding]:
    """Place a human skeleton inside a mesh and bind the mesh to it."""
    embedding = embed_skeleton(mesh, up=up, progress=progress)
    return SkinnedMesh(mesh, embedding.skeleton, heat_weights(mesh, embedding)), embedding
