"""Deformation gradients as a shape space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tempose._validate import as_floats
from tempose.rotations import from_rotation_vector, to_matrix
from tempose.shape_spaces.gradient.branches import follow_path
from tempose.shape_spaces.gradient.faces import FaceGradients, as_vectors
from tempose.shape_spaces.gradient.references import as_axes, reference_frames
from tempose.typing import FloatArray, IntArray

TOGETHER = 16
"""Frames solved at once: their right-hand sides fill the widest block of the solver."""


_SYMMETRIC = np.array([[3, 6, 7], [6, 4, 8], [7, 8, 5]])  # row of each entry of a stretch


class GradientSpace:
    """Rotation and stretch of every face against the rest, and the centre of every connected piece.

    d = 9 m + 3 for a mesh of one piece: 3 numbers of rotation and 6 of stretch a face, 3 of place.

    Parameters
    ----------
    rest : (n, 3) float
        Rest vertices, metres.
    faces : (m, 3) int
        Faces; some may be degenerate.
    references : (m, 3, 3) float, optional
        Rotation of every face against the rest from which its rotations are counted; none if not given.

    Raises
    ------
    ValueError
        If there are no faces, none has an area, or an index or a shape is wrong.

    Notes
    -----
    Section 5 of [1]_ after [2]_: the deformation gradient T of a face, its normal scaled by the root of the
    area, is split into ``T = M exp(w) S``, M the reference rotation, S symmetric. What differs from [1]_:

    - Rotations are relative to M, the mean of the face over the clip, so that angles stay small.
    - w and ``S - 1`` are given in axes of the face at rest (first axis along its longest edge, third axis the
      normal), which changes no distance; then S has two entries that are always zero and one, the stretch of
      the normal, that follows from the others and is not read by `decode`.
    - Everything is multiplied by the root of the face's share in the area, entries beside the diagonal by
      sqrt 2, places divided by the rms radius of the mesh: the Euclidean distance of two vectors does not
      depend on unit, tessellation or choice of axes, and zero is the rest in its mean orientation.
    - A mesh of c pieces (a vertex without faces is one) has c places: d = 9 m + 3 c.

    Layout of a vector: 9 rows of m numbers (w; xx, yy, zz, xy, xz, yz), then c places.
    A triangle has no mirror image that a rotation does not give too: no determinant is ever negative.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31(2), 2012.
    .. [2] Sumner and Popovic, "Deformation transfer for triangle meshes", SIGGRAPH 2004.
    """

    name: ClassVar[str] = "gradient"

    def __init__(self, rest: FloatArray, faces: IntArray, references: FloatArray | None = None) -> None:
        self.gradients = FaceGradients(rest, faces)
        n_faces = self.gradients.n_faces
        if references is None:
            references = np.tile(np.eye(3), (n_faces, 1, 1))
        self.n_vertices = self.gradients.n_vertices
        self._count_from(references)

    def _count_from(self, references: FloatArray) -> None:
        self.references = as_floats(references, "references", (self.gradients.n_faces, 3, 3))
        self._frames = self.gradients.frames(self.references)

    @property
    def dimension(self) -> int:
        """Length d of a vector."""
        return 9 * self.gradients.n_faces + 3 * self.gradients.n_pieces

    def encode(self, V: FloatArray) -> FloatArray:
        """Measure rotation and stretch of every face; rotations by at most half a turn.

        Parameters
        ----------
        V : (..., n, 3) float
            Vertex positions, metres.

        Returns
        -------
        (..., d) ndarray of float64
            Coordinates.

        Raises
        ------
        ValueError
            If the shape is wrong or a value is not finite.
        """
        V = np.asarray(V)
        frames = V.reshape(-1, *V.shape[-2:])
        z = np.zeros((len(frames), self.dimension))
        for t in range(len(frames)):
            self.gradients.encode(frames[t], self._frames, z[t])
        return z.reshape(*V.shape[:-2], self.dimension)

    def encode_path(self, V: FloatArray, after: FloatArray | None = None) -> FloatArray:
        """Measure the frames of a clip; rotations go on from frame to frame, past half a turn too.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames in the order of time.
        after : (d,) float, optional
            Coordinates of the frame before the first, from which to go on. If not given, the frame nearest to
            the reference is measured as `encode` does and the others go on from it in both directions.

        Returns
        -------
        (T, d) ndarray of float64
            Coordinates.

        Raises
        ------
        ValueError
            If the shape is wrong or a value is not finite.
        """
        z = self.encode(V)
        if z.ndim != 2:
            raise ValueError(f"V must have shape (T, {self.n_vertices}, 3), got {np.shape(V)}")
        m = self.gradients.n_faces
        if after is not None:
            after = as_floats(after, "after", (self.dimension,))[: 3 * m].reshape(3, m)
        follow_path(z[:, : 3 * m].reshape(-1, 3, m), self.gradients.weigh, after)
        return z

    def decode(self, z: FloatArray) -> FloatArray:
        """Find the mesh whose faces come nearest to the wanted rotations and stretches.

        Parameters
        ----------
        z : (..., d) float
            Coordinates.

        Returns
        -------
        (..., n, 3) ndarray of float64
            Vertex positions, metres.

        Raises
        ------
        ValueError
            If the shape is wrong or a value is not finite.
        """
        z = np.asarray(z, dtype=np.float64)
        rows = as_vectors(z, self.dimension)
        out = np.zeros((len(rows), self.n_vertices, 3))
        for t in range(0, len(rows), TOGETHER):
            block = slice(t, t + TOGETHER)
            self.gradients.decode(rows[block], self._frames, out[block])
        return out.reshape(*z.shape[:-1], self.n_vertices, 3)

    def deformations(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Read rotations and stretches out of vectors, in the axes of the world.

        Parameters
        ----------
        z : (..., d) float
            Coordinates.

        Returns
        -------
        rotations : (..., m, 3, 3) ndarray
            Rotation R of every face against the rest.
        stretches : (..., m, 3, 3) ndarray
            Symmetric S; the deformation gradient is ``R S``.
        """
        z = np.asarray(z, dtype=np.float64)
        m = self.gradients.n_faces
        rows = np.moveaxis(z[..., : 9 * m].reshape(*z.shape[:-1], 9, m) / self.gradients.scale, -2, -1)
        turns = to_matrix(from_rotation_vector(rows[..., :3]))
        local = rows[..., _SYMMETRIC] * np.where(np.eye(3) == 1, 1.0, np.sqrt(0.5)) + np.eye(3)
        rest, reference = as_axes(self.gradients.frames()), as_axes(self._frames)
        rest_inverse = rest.swapaxes(-1, -2)
        return reference @ turns @ rest_inverse, rest @ local @ rest_inverse

    def state(self) -> dict[str, FloatArray]:
        """Return what `from_state` needs.

        Returns
        -------
        dict of str to ndarray
            ``rest``, ``faces`` and ``references``, all as float64.
        """
        faces = self.gradients.faces.astype(np.float64)
        return {"rest": self.gradients.rest, "faces": faces, "references": self.references}

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> GradientSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        GradientSpace
            The same space.
        """
        return cls(state["rest"], np.asarray(state["faces"]).astype(np.int64), state["references"])

    @classmethod
    def from_clip(cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None) -> GradientSpace:
        """Make the space that counts rotations from the mean of every face over a clip.

        Parameters
        ----------
        rest : (n, 3) float
            Rest vertices, metres.
        faces : (m, 3) int
            Faces.
        frames : (T, n, 3) float, optional
            A clip or example poses; rotations are counted from the rest if not given.

        Returns
        -------
        GradientSpace
            Ready to encode and decode.

        Raises
        ------
        ValueError
            If a shape or an index is wrong, or no face has an area.
        """
        space = cls(rest, faces)
        if frames is None or len(frames) == 0:
            return space
        turned = as_axes(reference_frames(space.gradients, frames))
        space._count_from(turned @ as_axes(space._frames).transpose(0, 2, 1))
        return space
