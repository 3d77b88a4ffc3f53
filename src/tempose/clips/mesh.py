"""A still triangle mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from tempose._validate import as_floats, as_indices, read_only
from tempose.clips._frozen import Frozen
from tempose.clips.source import Source
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Mesh(Frozen):
    """Triangles in space: right-handed, Y up, +Z front, metres, counter-clockwise faces."""

    vertices: FloatArray
    """(n, 3) float64, metres."""
    faces: IntArray
    """(m, 3) int32, 0-based."""
    uv: FloatArray | None = None
    """(k, 2) float64 texture coordinates, a list of its own as in OBJ; origin at the lower left."""
    uv_faces: IntArray | None = None
    """(m, 3) int32 into `uv`; None with `uv` given means that uv follows the vertices (k = n)."""
    colors: FloatArray | None = None
    """(n, 3) float64, 0 to 1."""
    groups: Mapping[str, IntArray] = field(default_factory=dict[str, IntArray])
    """Name to (k,) int32 face indices; groups may overlap and need not cover the mesh."""
    polygons: IntArray | None = None
    """(p,) int32 corner counts when faces are fans of larger polygons, in order; None for triangles."""
    name: str = ""
    """Name for a person to read."""
    source: Source = field(default_factory=Source)
    """What the file said; vertices here are already converted."""

    def __post_init__(self) -> None:
        vertices = as_floats(self.vertices, "vertices", ("n", 3))
        n = len(vertices)
        faces = as_indices(self.faces, "faces", ("m", 3), limit=n)
        set_ = object.__setattr__
        set_(self, "vertices", read_only(vertices))
        set_(self, "faces", read_only(faces))
        self._check_attributes(n, len(faces))
        groups = {
            str(k): read_only(as_indices(v, f"groups[{k!r}]", ("k",), limit=len(faces)))
            for k, v in self.groups.items()
        }
        set_(self, "groups", MappingProxyType(groups))

    def _check_attributes(self, n: int, m: int) -> None:
        set_ = object.__setattr__
        if self.uv is not None:
            set_(
                self, "uv", read_only(as_floats(self.uv, "uv", ("k" if self.uv_faces is not None else n, 2)))
            )
        if self.uv_faces is not None:
            if self.uv is None:
                raise ValueError("uv_faces needs uv, got None")
            set_(
                self, "uv_faces", read_only(as_indices(self.uv_faces, "uv_faces", (m, 3), limit=len(self.uv)))
            )
        if self.colors is not None:
            set_(self, "colors", read_only(as_floats(self.colors, "colors", (n, 3))))
        if self.polygons is not None:
            polygons = as_indices(self.polygons, "polygons", ("p",))
            if (polygons < 3).any() or int((polygons - 2).sum()) != m:
                raise ValueError(
                    f"polygons must be corner counts >= 3 that fan into {m} triangles, "
                    f"got {int((polygons - 2).sum())} triangles"
                )
            set_(self, "polygons", read_only(polygons))

    def with_vertices(self, vertices: FloatArray) -> Mesh:
        """Return the same mesh with other positions.

        Parameters
        ----------
        vertices : (n, 3) float
            New positions, metres.

        Returns
        -------
        Mesh
            Shares every other array with this one.
        """
        return replace(self, vertices=vertices)

    @property
    def diagonal(self) -> float:
        """Diagonal of the bounding box, metres: the `D` of every relative tolerance."""
        if len(self.vertices) == 0:
            return 0.0
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @property
    def height(self) -> float:
        """Extent along Y, metres."""
        return float(np.ptp(self.vertices[:, 1])) if len(self.vertices) else 0.0
