"""Edge lengths and dihedral angles as a shape space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tempose.shape_spaces.edge_dihedral.assembly import make_assembly
from tempose.shape_spaces.edge_dihedral.decoded import Decoded
from tempose.shape_spaces.edge_dihedral.frames import check_coordinates, check_meshes, over_rows
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals
from tempose.shape_spaces.edge_dihedral.pinches import join_pinches
from tempose.shape_spaces.edge_dihedral.placement import Placement
from tempose.shape_spaces.edge_dihedral.reference import Reference, make_reference
from tempose.shape_spaces.edge_dihedral.refine import Refinement
from tempose.shape_spaces.edge_dihedral.weights import edge_areas
from tempose.typing import FloatArray, IntArray

_BEND = 0.3
_SHORTEST = 1e-3
_MISMATCH = 1e-6
_NEAR = 0.02
_TURN = 2 * np.pi


class EdgeDihedralSpace:
    """Lengths of edges, signed dihedral angles and six numbers for the place: d = 2 E + 6.

    Parameters
    ----------
    reference : Reference
        What is counted from; `from_clip` makes it.
    refinements : int, default 2
        Gauss-Newton steps at most for coordinates further than 0.02 (an rms strain of 2 %) from those of the
        mesh found: means of far poses, not frames of a clip with few modes left out. A step costs a
        factorisation, some thirty times the rest of decoding.

    Notes
    -----
    A coordinate of length is ``sqrt(A_e / A) l / l_0``, one of angle ``0.3 sqrt(A_e / A) theta``: A_e is a
    third of the area of the faces at the edge, A the area of the mesh, l_0 the mean length over the clip. So
    distances are free of units, small triangles count little, and a radian counts like a strain of 30 %.
    At the boundary an edge has no angle; its coordinate is 0. Each further connected part adds six numbers,
    a loose vertex three, each face beyond two at an edge one.

    References
    ----------
    .. [1] Winkler et al., "Multi-Scale Geometry Interpolation", Eurographics 2010.
    .. [2] Fröhlich and Botsch, "Example-Driven Deformations Based on Discrete Shells", 2011.
    """

    name: ClassVar[str] = "edge-dihedral"

    def __init__(self, reference: Reference, refinements: int = 2) -> None:
        if refinements < 0:
            raise ValueError(f"refinements must be 0 or more, got {refinements}")
        self.reference, self.refinements = reference, int(refinements)
        self.hinges = hinges = find_hinges(reference.faces)
        l0 = reference.lengths
        areas = edge_areas(hinges, l0)
        self.length_weights = np.sqrt(areas / areas.sum()) / l0
        edge_of_slot = np.arange(hinges.n_slots)
        edge_of_slot[hinges.slot] = hinges.edge
        self.angle_weights = _BEND * np.sqrt(areas / areas.sum())[edge_of_slot]
        self.placement = Placement(reference.vertices, reference.faces, reference.steadiness)
        self.assembly = make_assembly(reference, hinges)
        self.refinement = Refinement(
            reference.faces, len(reference.vertices), hinges, self.length_weights, self.angle_weights
        )
        self.n_edges, self.n_shape = len(l0), len(l0) + hinges.n_slots

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
            Coordinates; angles within half a turn of the reference.

        Raises
        ------
        ValueError
            If the shape is wrong, a value is not finite, or an edge has no length.
        """
        return over_rows(self._encode, check_meshes(V, self.n_vertices), 2, (self.dimension,))

    def encode_path(self, V: FloatArray) -> FloatArray:
        """Measure the frames of a clip; angles go on from the frame before.

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
        angles = path[:, self.n_edges : self.n_shape]
        angles[:] = np.unwrap(angles / self.angle_weights, axis=0) * self.angle_weights
        self.placement.unwrap(path[:, self.n_shape :])
        return path

    def _encode(self, V: FloatArray) -> FloatArray:
        V = V[self.reference.source]
        lengths, angles = lengths_and_dihedrals(V, self.reference.faces, self.hinges)
        away = angles - self.reference.dihedrals
        angles = angles - np.round(away / _TURN) * _TURN
        place = self.placement.encode(V)
        return np.concatenate([lengths * self.length_weights, angles * self.angle_weights, place])

    def decode(self, z: FloatArray) -> FloatArray:
        """Build meshes, by least squares where lengths and angles belong to none.

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
        return self._decoded(z, self.refinements, _NEAR).vertices

    def decode_measured(self, z: FloatArray, refinements: int | None = None, near: float = _NEAR) -> Decoded:
        """Build one mesh and say how near to the coordinates it came.

        Parameters
        ----------
        z : (d,) float
            Coordinates.
        refinements : int, optional
            Gauss-Newton steps at most; those of the space if not given.
        near : float, default 0.02
            Distance to the coordinates that needs no steps.

        Returns
        -------
        Decoded
            The mesh that `decode` gives, with its measures.

        Raises
        ------
        ValueError
            If the shape is wrong or a value is not finite.
        """
        z = check_coordinates(z, self.dimension).reshape(self.dimension)
        return self._decoded(z, self.refinements if refinements is None else refinements, near)

    def _decoded(self, z: FloatArray, refinements: int, near: float) -> Decoded:
        lengths = z[: self.n_edges] / self.length_weights
        lengths = np.maximum(lengths, _SHORTEST * self.reference.lengths)
        angles = z[self.n_edges : self.n_shape] / self.angle_weights
        built = self.assembly.build(lengths, angles)
        steps = refinements if built.mismatch > _MISMATCH else 0
        found = self.refinement.refine(built.vertices, lengths, angles, steps, near)
        V = join_pinches(self.placement.place(found.vertices, z[self.n_shape :]), self.reference.source)
        return Decoded(V, np.sqrt(found.energy), built.mismatch, found.n_iter, found.converged or steps == 0)

    def state(self) -> dict[str, FloatArray]:
        """Return what `from_state` needs.

        Returns
        -------
        dict of str to ndarray
            The fields of the reference, and ``refinements``.
        """
        return {**self.reference.state(), "refinements": np.array([float(self.refinements)])}

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> EdgeDihedralSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        EdgeDihedralSpace
            The same space.
        """
        return cls(Reference.from_state(state), int(state["refinements"][0]))

    @classmethod
    def from_clip(
        cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None
    ) -> EdgeDihedralSpace:
        """Make the space of a mesh.

        Parameters
        ----------
        rest : (n, 3) float
            Rest vertices, metres.
        faces : (m, 3) int
            Faces.
        frames : (T, n, 3) float, optional
            A clip or poses: lengths and angles are counted from their mean.

        Returns
        -------
        EdgeDihedralSpace
            Ready to encode and decode.

        Raises
        ------
        ValueError
            If there is no face, a face names a vertex twice, or an edge has no length.
        """
        return cls(make_reference(rest, faces, frames))
