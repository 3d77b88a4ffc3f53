"""Edge lengths and heights over tangent planes as a shape space: linear rotation-invariant coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tempose.shape_spaces.edge_dihedral.assembly import make_assembly
from tempose.shape_spaces.edge_dihedral.frames import check_coordinates, check_meshes, over_rows
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals
from tempose.shape_spaces.edge_dihedral.pinches import join_pinches
from tempose.shape_spaces.edge_dihedral.placement import Placement
from tempose.shape_spaces.edge_dihedral.reference import (
    Reference,
    make_reference,
    sample_poses,
)
from tempose.shape_spaces.edge_dihedral.triangles import lay_out
from tempose.shape_spaces.edge_dihedral.weights import edge_areas
from tempose.shape_spaces.rotation_invariant.angles import dihedrals_from_normals, views_of_normals
from tempose.shape_spaces.rotation_invariant.fans import corner_fronts
from tempose.shape_spaces.rotation_invariant.heights import heights_and_cosines
from tempose.shape_spaces.rotation_invariant.normals import normals_in_faces
from tempose.shape_spaces.rotation_invariant.signs import SignSearch
from tempose.typing import FloatArray, IntArray

_HEIGHT = 0.5
_SHORTEST = 1e-3


class RotationInvariantSpace:
    """Lengths of edges, heights of their ends over each other's tangent plane, and the place: d = 3 E + 6.

    Parameters
    ----------
    reference : Reference
        What is counted from; `from_clip` makes it.
    signs : (m, 3) float
        1 where the normal of a corner's vertex lies on the front of its face in the reference, else -1.
    """

    name: ClassVar[str] = "rotation-invariant"

    def __init__(self, reference: Reference, signs: FloatArray) -> None:
        self.reference = reference
        self.signs = signs
        self.hinges = hinges = find_hinges(reference.faces)
        self.fronts = corner_fronts(reference.faces, hinges)
        l0 = reference.lengths
        areas = edge_areas(hinges, l0)
        self.length_weights = np.sqrt(areas / areas.sum()) / l0
        self.height_weights = _HEIGHT * np.repeat(self.length_weights, 2)
        self.placement = Placement(reference.vertices, reference.faces, reference.steadiness)
        self.assembly = make_assembly(reference, hinges)
        self.search = SignSearch(reference.faces, len(reference.vertices), hinges.edges[hinges.edge])
        self.n_edges, self.n_shape = len(l0), 3 * len(l0)

    @property
    def dimension(self) -> int:
        """Length d of a vector."""
        return self.n_shape + self.placement.dimension

    @property
    def n_vertices(self) -> int:
        """Number n of vertices of a mesh."""
        return self.reference.n_vertices

    def encode(self, V: FloatArray) -> FloatArray:
        """Measure meshes, each for itself.

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
            If the shape is wrong, a value is not finite, or an edge has no length.
        """
        return over_rows(self._encode, check_meshes(V, self.n_vertices), 2, (self.dimension,))

    def encode_path(self, V: FloatArray) -> FloatArray:
        """Measure the frames of a clip; the rotation of each part goes on from the frame before.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames in the order of time.

        Returns
        -------
        (T, d) ndarray of float64
            Coordinates.
        """
        path = self.encode(V)
        self.placement.unwrap(path[:, self.n_shape :])
        return path

    def _encode(self, V: FloatArray) -> FloatArray:
        V = V[self.reference.source]
        lengths, _ = lengths_and_dihedrals(V, self.reference.faces, self.hinges)
        heights, _ = heights_and_cosines(V, self.reference.faces, self.hinges, self.fronts)
        shape = [lengths * self.length_weights, heights.ravel() * self.height_weights]
        return np.concatenate([*shape, self.placement.encode(V)])

    def decode(self, z: FloatArray) -> FloatArray:
        """Build meshes, by least squares where lengths and heights belong to none.

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
        return over_rows(self._decode, check_coordinates(z, self.dimension), 1, (self.n_vertices, 3))

    def _decode(self, z: FloatArray) -> FloatArray:
        lengths, dihedrals, _ = self._dihedrals(z)
        built = self.assembly.build(lengths, dihedrals)
        return join_pinches(self.placement.place(built.vertices, z[self.n_shape :]), self.reference.source)

    def _dihedrals(self, z: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        lengths = z[: self.n_edges] / self.length_weights
        lengths = np.maximum(lengths, _SHORTEST * self.reference.lengths)
        heights = (z[self.n_edges : self.n_shape] / self.height_weights).reshape(-1, 2)
        sides = lengths[self.hinges.face_edges]
        directions, _ = lay_out(sides)
        N = normals_in_faces(self.hinges, sides, directions, heights)
        corners, views = views_of_normals(self.hinges, directions, N)
        signs, doubt = self.search.signs(corners, views, self.signs.ravel())
        return lengths, dihedrals_from_normals(self.hinges, corners, views, signs), doubt

    def state(self) -> dict[str, FloatArray]:
        """Return what `from_state` needs.

        Returns
        -------
        dict of str to ndarray
            The fields of the reference, and ``signs``.
        """
        return {**self.reference.state(), "signs": np.array(self.signs)}

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> RotationInvariantSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        RotationInvariantSpace
            The same space.
        """
        return cls(Reference.from_state(state), np.array(state["signs"], dtype=np.float64))

    @classmethod
    def from_clip(
        cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None
    ) -> RotationInvariantSpace:
        """Make the space of a mesh.

        Parameters
        ----------
        rest : (n, 3) float
            Rest vertices, metres.
        faces : (m, 3) int
            Faces.
        frames : (T, n, 3) float, optional
            A clip or poses: lengths are weighed by their mean, folds looked for where the clip has them.

        Returns
        -------
        RotationInvariantSpace
            Ready to encode and decode.

        Raises
        ------
        ValueError
            If there is no face, a face names a vertex twice, or an edge has no length.
        """
        reference = make_reference(rest, faces, frames)
        hinges = find_hinges(reference.faces)
        fronts = corner_fronts(reference.faces, hinges)
        cosines = np.zeros(reference.faces.shape)
        for V in sample_poses(rest, frames)[:, reference.source]:
            cosines += heights_and_cosines(V, reference.faces, hinges, fronts)[1]
        return cls(reference, np.where(cosines < 0, -1.0, 1.0))
