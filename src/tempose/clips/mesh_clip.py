"""A deforming mesh of fixed connectivity."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose._validate import read_only
from tempose.clips._frozen import Frozen
from tempose.clips.mesh import Mesh
from tempose.clips.source import Source
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class MeshClip(Frozen):
    """Frames of one mesh: positions per frame over the topology of `mesh`."""

    vertices: FloatArray
    """(T, n, 3) float32, metres; an array or a memory map."""
    mesh: Mesh
    """Rest pose, faces, UVs, groups and name."""
    fps: float = 30.0
    """Frames per second."""
    source: Source = field(default_factory=Source)
    """What the file said."""

    def __post_init__(self) -> None:
        vertices = self.vertices if isinstance(self.vertices, np.memmap) else np.asarray(self.vertices)
        n = len(self.mesh.vertices)
        if vertices.ndim != 3 or vertices.shape[1:] != (n, 3):
            raise ValueError(f"vertices must have shape (T, {n}, 3), got {vertices.shape}")
        if vertices.dtype != np.float32:
            vertices = vertices.astype(np.float32)
        for t, frame in enumerate(vertices):
            if not np.isfinite(frame).all():
                raise ValueError(f"vertices must be finite, found NaN or infinity in frame {t}")
        if not 0 < self.fps < float("inf"):
            raise ValueError(f"fps must be positive, got {self.fps}")
        object.__setattr__(self, "vertices", read_only(vertices))
        object.__setattr__(self, "fps", float(self.fps))

    @property
    def faces(self) -> IntArray:
        """(m, 3) int32 faces, the same in every frame."""
        return self.mesh.faces

    @property
    def rest(self) -> FloatArray:
        """(n, 3) float64 rest positions, metres."""
        return self.mesh.vertices

    @property
    def name(self) -> str:
        """Name of the mesh."""
        return self.mesh.name

    @property
    def n_frames(self) -> int:
        """Number of frames T."""
        return len(self.vertices)

    @property
    def times(self) -> FloatArray:
        """(T,) seconds, frame 0 at 0."""
        return np.arange(self.n_frames) / self.fps

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return max(self.n_frames - 1, 0) / self.fps
