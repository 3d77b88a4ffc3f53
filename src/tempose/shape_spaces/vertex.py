"""Vertex positions themselves: the simplest shape space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tempose.typing import FloatArray, IntArray


class VertexSpace:
    """Stacked vertex positions, d = 3 n.

    Parameters
    ----------
    n_vertices : int
        Number n of vertices.
    """

    name: ClassVar[str] = "vertex"

    def __init__(self, n_vertices: int) -> None:
        if n_vertices < 1:
            raise ValueError(f"n_vertices must be at least 1, got {n_vertices}")
        self.n_vertices = int(n_vertices)

    @property
    def dimension(self) -> int:
        """Length d of a vector."""
        return 3 * self.n_vertices

    def encode(self, V: FloatArray) -> FloatArray:
        """Stack the positions of each mesh.

        Parameters
        ----------
        V : (..., n, 3) float
            Vertex positions, metres.

        Returns
        -------
        (..., 3 n) ndarray of float64
            Coordinates.
        """
        V = np.asarray(V, dtype=np.float64)
        return V.reshape(*V.shape[:-2], self.dimension)

    encode_path = encode

    def decode(self, z: FloatArray) -> FloatArray:
        """Unstack the positions.

        Parameters
        ----------
        z : (..., 3 n) float
            Coordinates.

        Returns
        -------
        (..., n, 3) ndarray of float64
            Vertex positions, metres.
        """
        z = np.asarray(z, dtype=np.float64)
        return z.reshape(*z.shape[:-1], self.n_vertices, 3)

    def state(self) -> dict[str, FloatArray]:
        """Return what `from_state` needs.

        Returns
        -------
        dict of str to ndarray
            ``n_vertices``.
        """
        return {"n_vertices": np.array([self.n_vertices], dtype=np.float64)}

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> VertexSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        VertexSpace
            The same space.
        """
        return cls(int(state["n_vertices"][0]))

    @classmethod
    def from_clip(cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None) -> VertexSpace:
        """Make the space of a mesh.

        Parameters
        ----------
        rest : (n, 3) float
            Rest vertices.
        faces : (m, 3) int
            Not used.
        frames : (T, n, 3) float, optional
            Not used.

        Returns
        -------
        VertexSpace
            For n vertices.
        """
        return cls(len(rest))
