"""The frames of a clip as a fit reads them: block by block, without the placement if it is split off."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.clips import Mesh, MeshClip
from tempose.clips.blocks import read_block
from tempose.signals.blocks import block_slices
from tempose.signals.placement import fit_placements, in_body
from tempose.typing import FloatArray, IntArray, Progress, silent

IN_MEMORY = 40_000_000
"""Numbers of a clip, 320 MB as float64, from which on it is read in passes."""

MANY_FRAMES = 600
"""Frames from which on few components are found by a random sketch, not by the pairs of all frames."""


FOLLOWING = ("vertex", "gradient", "patch")
"""Spaces whose coordinates can be found block by block: rotations go on from the block before."""


@dataclass(frozen=True, eq=False)
class ClipFrames:
    """A clip, and where its body is in every frame if that is split off."""

    clip: MeshClip
    """T frames of n vertices."""
    placements: FloatArray | None
    """(T, 7) rotations wxyz and translations; None: the frames stand as they are."""
    diagonal: float
    """D, metres."""

    @classmethod
    def of(cls, clip: MeshClip, split: bool, progress: Progress = silent) -> ClipFrames:
        """Look at a clip.

        Parameters
        ----------
        clip : MeshClip
            The clip.
        split : bool
            Whether the placement of the body is split off.
        progress : Progress, optional
            Told how many frames have been placed.

        Returns
        -------
        ClipFrames
            Its frames.
        """
        placements = fit_placements(clip.vertices, clip.rest, progress=progress) if split else None
        return cls(clip, placements, clip_diagonal(clip))

    @property
    def percent(self) -> float:
        """Rms percent of the diagonal for the root of a sum of squares over all vertices and frames."""
        T, n, _ = self.clip.vertices.shape
        return 100.0 / (self.diagonal * float(np.sqrt(T * max(n, 1))))

    @property
    def long(self) -> bool:
        """Whether the clip is too large to be held as numbers of double precision."""
        return self.clip.vertices.size > IN_MEMORY

    def streamed(self, m: int | None, space: str = "vertex") -> bool:
        """Whether principal components are to be found in passes over the clip.

        Parameters
        ----------
        m : int or None
            Number asked for; None where a tolerance decides.
        space : str, default "vertex"
            Shape space; coordinates of others than vertices are about six times as many.

        Returns
        -------
        bool
            True for a long clip, and for one of many frames unless nearly all components are wanted: one
            matrix of all pairs of frames costs the cube of their number.
        """
        many = self.clip.n_frames > MANY_FRAMES and (m is None or m < self.clip.n_frames // 2)
        wide = space != "vertex" and self.clip.vertices.size > IN_MEMORY // 3
        return self.long or wide or (many and space in FOLLOWING)

    def motion(self) -> float:
        """Return how much the clip moves.

        Returns
        -------
        float
            Rms percent of the diagonal by which vertices move about their means.
        """
        T, first = self.clip.n_frames, self.block(slice(0, 1)).reshape(-1)
        total, moment = 0.0, np.zeros_like(first)
        for block in self.blocks():
            off = block - first
            total += float(np.vdot(off, off))
            moment += off.sum(axis=0)
        return self.percent * float(np.sqrt(max(total - float(moment @ moment) / T, 0.0)))

    def block(self, frames: slice | IntArray) -> FloatArray:
        """Return some frames.

        Parameters
        ----------
        frames : slice or (k,) int
            Which.

        Returns
        -------
        (k, n, 3) ndarray of float64
            Vertices, about the body's own origin if the placement is split off.
        """
        V = np.array(self.clip.vertices[frames], dtype=np.float64)
        return V if self.placements is None else in_body(V, self.placements[frames], V)

    def blocks(self, values: int | None = None) -> Iterator[FloatArray]:
        """Yield the frames in blocks, in order, flattened.

        Parameters
        ----------
        values : int, optional
            Numbers that the caller makes of one frame, where they are more than its coordinates.

        Yields
        ------
        (k, 3 n) ndarray of float64
            Vertices of some frames.
        """
        for frames in block_slices(self.clip.n_frames, max(values or 0, 3 * len(self.clip.rest))):
            V = read_block(self.clip.vertices, frames)
            V = V if self.placements is None else in_body(V, self.placements[frames])
            yield V.reshape(len(V), -1)


def clip_diagonal(clip: MeshClip) -> float:
    """Return the D of tolerances.

    Parameters
    ----------
    clip : MeshClip
        Any clip.

    Returns
    -------
    float
        Metres: of the rest mesh, of all frames where that is a point, 1 where those are too.
    """
    if clip.mesh.diagonal > 0 or not clip.vertices.size:
        return clip.mesh.diagonal or 1.0
    return float(np.linalg.norm(np.ptp(np.asarray(clip.vertices).reshape(-1, 3), axis=0))) or 1.0


def example_vertices(examples: Any, mesh: Mesh) -> FloatArray | None:
    """Check example poses.

    Parameters
    ----------
    examples : (e, n, 3) float, sequence of Mesh, or None
        Poses of the mesh.
    mesh : Mesh
        The mesh of the clip.

    Returns
    -------
    (e, n, 3) ndarray or None
        Their vertices.

    Raises
    ------
    ValueError
        If there are fewer than two, or one has another number of vertices.
    """
    if examples is None:
        return None
    n = len(mesh.vertices)
    rows = [e.vertices if isinstance(e, Mesh) else e for e in examples]
    Q = [as_floats(row, f"examples[{i}]", (n, 3)) for i, row in enumerate(rows)]
    if len(Q) < 2:
        raise ValueError(f"examples must hold two poses or more, got {len(Q)}")
    return np.stack(Q)
