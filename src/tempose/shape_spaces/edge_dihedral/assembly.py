"""A mesh put together from lengths and dihedral angles."""

from __future__ import annotations

from dataclasses import dataclass

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals
from tempose.shape_spaces.edge_dihedral.positions import VertexPositions
from tempose.shape_spaces.edge_dihedral.reference import Reference
from tempose.shape_spaces.edge_dihedral.triangles import lay_out
from tempose.shape_spaces.edge_dihedral.turns import FaceTurns
from tempose.shape_spaces.edge_dihedral.weights import hinge_stiffness
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Assembled:
    """Vertices and how well the numbers fitted together."""

    vertices: FloatArray
    """(n, 3) metres, each part somewhere."""
    mismatch: float
    """Root mean square of the angles by which neighbouring faces disagree, radians; 0 for a mesh."""
    n_iter: int
    """Steps towards the rotations of the faces."""


class Assembly:
    """Two least-squares problems, each factorised once: rotations of the faces, then the vertices.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    hinges : Hinges
        Of the faces.
    n : int
        Number of vertices.
    lengths : (E,) float
        At rest, metres.
    stiffness : (H,) float
        How much each hinge counts, positive.
    """

    def __init__(
        self,
        F: IntArray,
        hinges: Hinges,
        n: int,
        lengths: FloatArray,
        stiffness: FloatArray,
    ) -> None:
        self.hinges = hinges
        self.turns = FaceTurns(hinges, stiffness)
        sides = lengths[hinges.face_edges]
        self.positions = VertexPositions(F, n, sides, lay_out(sides)[1])

    def build(self, lengths: FloatArray, dihedrals: FloatArray) -> Assembled:
        """Put a mesh together.

        Parameters
        ----------
        lengths : (E,) float
            Metres, positive.
        dihedrals : (n_slots,) float
            Radians.

        Returns
        -------
        Assembled
            Exact if the numbers are those of a mesh.
        """
        sides = lengths[self.hinges.face_edges]
        directions, apex = lay_out(sides)
        R, mismatch, n_iter = self.turns.rotations(directions, dihedrals)
        return Assembled(self.positions.solve(sides, apex, R), mismatch, n_iter)


def make_assembly(reference: Reference, hinges: Hinges) -> Assembly:
    """Prepare to put meshes together that resemble a reference.

    Parameters
    ----------
    reference : Reference
        Mesh and what was measured of its clip.
    hinges : Hinges
        Of its faces.

    Returns
    -------
    Assembly
        Factorised.
    """
    lengths, dihedrals = lengths_and_dihedrals(reference.vertices, reference.faces, hinges)
    stiffness = hinge_stiffness(hinges, reference)
    n = len(reference.vertices)
    assembly = Assembly(reference.faces, hinges, n, reference.lengths, stiffness)
    assembly.turns.start_from(lay_out(lengths[hinges.face_edges])[0], dihedrals)
    return assembly
