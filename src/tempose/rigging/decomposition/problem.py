"""The clip as the decomposition sees it, and where the decomposition stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Problem:
    """Vertices of a clip about the centroids, in units of the diagonal; rows are vertices."""

    rest: FloatArray
    """(n, 3) rest positions."""
    lifted: FloatArray
    """(n, 4) rest positions and a one."""
    targets: FloatArray
    """(n, 3 T) where each vertex is in all frames."""
    squares: FloatArray
    """(n,) sum of the squares of `targets`."""
    alone: float = 0.0
    """How much a bone must carry by itself what follows it, against the blend: 0 is the blend only."""

    @classmethod
    def of(cls, rest: FloatArray, frames: FloatArray, alone: float = 0.0) -> Problem:
        """Arrange a clip.

        Parameters
        ----------
        rest : (n, 3) float
            Rest positions.
        frames : (T, n, 3) float
            Positions in every frame.
        alone : float, default 0.0
            How much a bone must carry by itself what follows it, against the blend.

        Returns
        -------
        Problem
            The same positions, vertex by vertex.
        """
        n = len(rest)
        targets = np.ascontiguousarray(np.asarray(frames, dtype=np.float64).transpose(1, 0, 2).reshape(n, -1))
        squares = np.einsum("ij,ij->i", targets, targets)
        return cls(rest, np.column_stack([rest, np.ones(n)]), targets, squares, alone)

    def part(self, vertices: IntArray) -> Problem:
        """Return the same clip on some vertices.

        Parameters
        ----------
        vertices : (k,) int
            Vertices to keep.

        Returns
        -------
        Problem
            The smaller clip.
        """
        rest, lifted = self.rest[vertices], self.lifted[vertices]
        return Problem(rest, lifted, self.targets[vertices], self.squares[vertices], self.alone)

    @property
    def n_frames(self) -> int:
        """Number of frames T."""
        return self.targets.shape[1] // 3


@dataclass
class State:
    """Bones and weights as they are being found."""

    motions: FloatArray
    """(T, B, 3, 4) rotation and translation of each bone, rest to frame."""
    bones: IntArray
    """(n, K) int64 bones of each vertex."""
    weights: FloatArray
    """(n, K) their weights; 0 where a place is free."""
    left: FloatArray
    """(n,) squared distance left, over all frames."""

    @property
    def n_bones(self) -> int:
        """Number of bones B."""
        return self.motions.shape[1]

    @property
    def columns(self) -> FloatArray:
        """(4 B, 3 T): what carries a lifted vertex to all frames, one block of rows a bone."""
        T, B = self.motions.shape[:2]
        return self.motions.transpose(1, 3, 0, 2).reshape(4 * B, 3 * T)
