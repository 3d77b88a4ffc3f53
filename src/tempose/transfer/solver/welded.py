"""A mesh whose seams are closed."""

from __future__ import annotations

from dataclasses import dataclass

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Welded:
    """A mesh in which equal positions are one vertex: a seam of its texture does not part it."""

    vertices: FloatArray
    """(w, 3) metres."""
    faces: IntArray
    """(m, 3) int, the faces of the mesh in the same order."""
    first: IntArray
    """(w,) int, one vertex of the mesh for each."""
    inverse: IntArray
    """(n,) int, the welded vertex of each vertex of the mesh."""
