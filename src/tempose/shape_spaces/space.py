"""What every shape space can do: meshes of one topology as points of a Euclidean space, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Protocol

from tempose.typing import FloatArray, IntArray


class ShapeSpace(Protocol):
    """Meshes of one topology as vectors that can be averaged, interpolated and analysed.

    The plain Euclidean distance of two vectors is the distance that the space means: weights such as
    areas are inside the coordinates.
    """

    name: ClassVar[str]
    """As on the command line: ``"vertex"``, ``"gradient"``, ``"rotation-invariant"``..."""

    @property
    def dimension(self) -> int:
        """Length d of a vector."""
        ...

    @property
    def n_vertices(self) -> int:
        """Number n of vertices of a mesh."""
        ...

    def encode(self, V: FloatArray) -> FloatArray:
        """Turn meshes into vectors, each for itself.

        Parameters
        ----------
        V : (..., n, 3) float
            Vertex positions, metres.

        Returns
        -------
        (..., d) ndarray of float64
            Coordinates.
        """
        ...

    def encode_path(self, V: FloatArray) -> FloatArray:
        """Turn the frames of a clip into vectors; angles go on from the frame before, past half a turn too.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames in the order of time.

        Returns
        -------
        (T, d) ndarray of float64
            Coordinates, a continuous path where the motion is.
        """
        ...

    def decode(self, z: FloatArray) -> FloatArray:
        """Turn vectors into meshes; also vectors that belong to no mesh, by least squares.

        Parameters
        ----------
        z : (..., d) float
            Coordinates.

        Returns
        -------
        (..., n, 3) ndarray of float64
            Vertex positions, metres.
        """
        ...

    def state(self) -> dict[str, FloatArray]:
        """Return the arrays that `from_state` of the class makes the same space from.

        Returns
        -------
        dict of str to ndarray
            Small names, such as ``"rest"`` and ``"faces"``.
        """
        ...

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> ShapeSpace:
        """Make the space that `state` describes.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        ShapeSpace
            The same space: encodes and decodes bit for bit alike.
        """
        ...

    @classmethod
    def from_clip(cls, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None) -> ShapeSpace:
        """Make the space of a mesh, or the one that suits its clip best.

        Parameters
        ----------
        rest : (n, 3) float
            Rest vertices, metres.
        faces : (m, 3) int
            Faces.
        frames : (T, n, 3) float, optional
            A clip, or example poses: rotations are then counted from each face's mean over them.

        Returns
        -------
        ShapeSpace
            Ready to encode and decode.

        Raises
        ------
        ValueError
            If the mesh has no faces, or a face of no area where the space needs it.
        """
        ...
