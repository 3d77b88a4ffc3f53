"""A mesh bound to a skeleton, and what is to be said about it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tempose.clips import SkinnedMesh
from tempose.embedding.cells import Cells


@dataclass(frozen=True)
class Bound:
    """How a mesh came by its skeleton."""

    skin: SkinnedMesh
    """Mesh, joints, weights."""
    facts: dict[str, Any] = field(default_factory=dict[str, Any])
    """Measures for the report: what JSON can hold."""
    warnings: tuple[str, ...] = ()
    """What a person should know before trusting it, one sentence each."""
    cells: Cells | None = None
    """The inside of the mesh, where it was looked for."""
