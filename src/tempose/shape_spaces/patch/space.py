"""Deformation gradients relative to patches as a shape space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tempose._validate import as_floats
from tempose.rotations import from_matrix, from_rotation_vector, polar_rotation, to_matrix, to_rotation_vector
from tempose.shape_spaces.gradient.branches import follow_path
from tempose.shape_spaces.gradient.faces import FaceGradients, as_vectors
from tempose.shape_spaces.gradient.references import as_axes
from tempose.shape_spaces.gradient.space import TOGETHER
from tempose.shape_spaces.patch.connection import mean_turn, rotations_from_steps
from tempose.shape_spaces.patch.kernels import sum_turns, turn_frames
from tempose.shape_spaces.patch.patches import Patches, make_patches, weighed_patches
from tempose.shape_spaces.patch.references import body_frames
from tempose.typing import FloatArray, IntArray

PATCHES = 80
"""Patches of a mesh that has enough faces; 20 do nearly as well."""
FACES_A_PATCH = 20
"""Faces that a patch has at least, on average."""


class PatchSpace:
    """Rotation and stretch of every face against the patch it lies in, and of patches against each other.

    d = 9 m + 3 e + 6 for a mesh of one piece, e pairs of neighbouring patches. A rotation of the whole
    changes three numbers, a movement of the whole another three.

    Parameters
    ----------
    rest : (n, 3) float
        Rest vertices, metres.
    faces : (m, 3) int
        Faces; some may be degenerate.
    references : (m, 3, 3) float, optional
        Rotation of every face against the rest from which rotations are counted; none if not given.
    patches : Patches, optional
        Made by `make_patches` if not given.
    steps : (e, 3, 3) float, optional
        Rotations between neighbouring patches from which theirs are counted; none if not given.

    Raises
    ------
    ValueError
        If there are no faces, none has an area, or an index or a shape is wrong.

    Notes
    -----
    After [1]_, on the deformation gradients of `GradientSpace`: P_p is the rotation nearest to the mean of
    those of patch p, each against its reference M; a face stores w and S of ``T = P_p M exp(w) S``, a pair of
    neighbours (a, b) the rotation vector of ``P_a^T P_b`` against its mean over the clip, the mesh the
    rotation of all patches together and the places of its c pieces: d = 9 m + 3 e + 3 + 3 c. Patches are
    found again from the pairs by one small linear solve.

    Pairs are weighted by the areas of their patches to sum 1, so that bending a body by an angle counts about
    as much as in `GradientSpace`.

    References
    ----------
    .. [1] Baran, Vlasic, Grinspun and Popovic, "Semantic deformation transfer", SIGGRAPH 2009.
    """

    name: ClassVar[str] = "patch"

    def __init__(
        self,
        rest: FloatArray,
        faces: IntArray,
        references: FloatArray | None = None,
        patches: Patches | None = None,
        steps: FloatArray | None = None,
    ) -> None:
        self.gradients = FaceGradients(rest, faces)
        self.n_vertices, m = self.gradients.n_vertices, self.gradients.n_faces
        shares = self.gradients.shape.shares
        if patches is None:
            count = min(PATCHES, -(-m // FACES_A_PATCH))
            patches = make_patches(self.gradients.rest, self.gradients.faces, shares, count)
        self.patches = patches
        self._count_from(
            np.tile(np.eye(3), (m, 1, 1)) if references is None else references,
            np.tile(np.eye(3), (len(patches.pairs), 1, 1)) if steps is None else steps,
        )
        # weights of the rotations between patches and, last, of the whole
        self._scale = np.append(np.sqrt(patches.pair_weights), 1.0)

    def _count_from(self, references: FloatArray, steps: FloatArray) -> None:
        self.references = as_floats(references, "references", (self.gradients.n_faces, 3, 3))
        self.steps = as_floats(steps, "steps", (len(self.patches.pairs), 3, 3))
        self._mean = self.gradients.frames(self.references)

    @property
    def dimension(self) -> int:
        """Length d of a vector."""
        pairs = len(self.patches.pairs)
        return 9 * self.gradients.n_faces + 3 * pairs + 3 + 3 * self.gradients.n_pieces

    def encode(self, V: FloatArray) -> FloatArray:
        """Measure rotations and stretches; rotations by at most half a turn.

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
        turned = self.gradients.frames()
        for row, frame in zip(z, frames):
            P = self._patch_rotations(frame, turned)
            a, b = P[self.patches.pairs.T]
            steps = self.steps.swapaxes(-1, -2) @ a.swapaxes(-1, -2) @ b
            whole = mean_turn(P, self.patches.shares)
            w = to_rotation_vector(from_matrix(np.concatenate([steps, whole[None]])))
            self._rotations(row)[:] = (w * self._scale[:, None]).T
            turn_frames(P, self.patches.of_face, self._mean, turned)
            self.gradients.encode(frame, turned, row)
        return z.reshape(*V.shape[:-2], self.dimension)

    def _patch_rotations(self, V: FloatArray, turned: FloatArray) -> FloatArray:
        """Rotations of the patches (p, 3, 3); overwrites `turned`."""
        self.gradients.turned(V, self._mean, turned)
        total = np.zeros((len(self.patches.shares), 3, 3))
        sum_turns(turned, self._mean, self.gradients.shape.shares, self.patches.of_face, total)
        return polar_rotation(total)

    def _rotations(self, z: FloatArray) -> FloatArray:
        """Rotation vectors (..., 3, e + 1) of pairs and, last, of the whole: a view."""
        m, e = self.gradients.n_faces, len(self.patches.pairs)
        return z[..., 9 * m : 9 * m + 3 * e + 3].reshape(*z.shape[:-1], 3, e + 1)

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
        before = None if after is None else as_floats(after, "after", (self.dimension,))
        of_faces = None if before is None else before[: 3 * m].reshape(3, m)
        follow_path(z[:, : 3 * m].reshape(-1, 3, m), self.gradients.weigh, of_faces)
        between = None if before is None else self._rotations(before)
        follow_path(self._rotations(z), 1 / self._scale, between)
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
            frames = np.ones((len(rows[block]), len(self._mean)))
            for P, turned in zip(self._solved_rotations(rows[block]), frames):
                turn_frames(P, self.patches.of_face, self._mean, turned)
            self.gradients.decode(rows[block], frames, out[block])
        return out.reshape(*z.shape[:-1], self.n_vertices, 3)

    def _solved_rotations(self, z: FloatArray) -> FloatArray:
        """Rotations of the patches (T, p, 3, 3) that vectors ask for."""
        w = self._rotations(z).swapaxes(-1, -2) / self._scale[:, None]
        turns = to_matrix(from_rotation_vector(w))
        P = rotations_from_steps(self.steps @ turns[:, :-1], self.patches)
        whole = turns[:, -1] @ mean_turn(P, self.patches.shares).swapaxes(-1, -2)
        return np.ascontiguousarray(whole[:, None] @ P)

    def state(self) -> dict[str, FloatArray]:
        """Return what `from_state` needs.

        Returns
        -------
        dict of str to ndarray
            ``rest``, ``faces``, ``references``, ``patch_of_face``, ``pairs`` and ``steps``, all as float64.
        """
        return {
            "rest": self.gradients.rest,
            "faces": self.gradients.faces.astype(np.float64),
            "references": self.references,
            "patch_of_face": self.patches.of_face.astype(np.float64),
            "pairs": self.patches.pairs.astype(np.float64),
            "steps": self.steps,
        }

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> PatchSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        PatchSpace
            The same space.
        """
        faces, of_face, pairs = (
            np.asarray(state[key]).astype(np.int64) for key in ("faces", "patch_of_face", "pairs")
        )
        shares = FaceGradients(state["rest"], faces).shape.shares
        patches = weighed_patches(of_face, pairs.reshape(-1, 2), shares)
        return cls(state["rest"], faces, state["references"], patches, state["steps"])

    @classmethod
    def from_clip(cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None) -> PatchSpace:
        """Make the space that counts rotations from their means over a clip.

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
        PatchSpace
            Ready to encode and decode.

        Raises
        ------
        ValueError
            If a shape or an index is wrong, or no face has an area.
        """
        space = cls(rest, faces)
        if frames is None or len(frames) == 0:
            return space
        axes = as_axes(body_frames(space.gradients, frames))
        references = axes @ as_axes(space.gradients.frames()).swapaxes(-1, -2)
        space._count_from(references, space.steps)
        turned, total = space.gradients.frames(), np.zeros(space.steps.shape)
        for V in frames:
            a, b = space._patch_rotations(V, turned)[space.patches.pairs.T]
            total += a.swapaxes(-1, -2) @ b
        space._count_from(references, polar_rotation(total))
        return space
