"""What spaces of face deformations share: faces at rest, the factor, and where pieces are."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.shape_spaces.gradient.decode_kernels import decode_faces
from tempose.shape_spaces.gradient.encode_kernels import encode_faces, turn_faces
from tempose.shape_spaces.gradient.poisson import MeshPoisson
from tempose.shape_spaces.gradient.rest_faces import rest_faces
from tempose.typing import FloatArray, IntArray


class FaceGradients:
    """Measure the deformation of every face of a mesh against frames, and rebuild the mesh.

    A vector begins with 9 rows of m numbers: rotation vector relative to the frame, stretch less the identity
    (xx, yy, zz, xy, xz, yz); it ends with the place of every connected piece.

    Parameters
    ----------
    rest : (n, 3) float
        Rest vertices, metres.
    faces : (m, 3) int
        Faces; some may be degenerate.

    Raises
    ------
    ValueError
        If there are no faces, none has an area, or an index or a shape is wrong.
    """

    def __init__(self, rest: FloatArray, faces: IntArray) -> None:
        self.rest = as_floats(rest, "rest", ("n", 3))
        self.faces = as_indices(faces, "faces", ("m", 3), limit=len(self.rest))
        if len(self.faces) == 0:
            raise ValueError("faces must hold at least one face, got none")
        self.shape = rest_faces(self.rest, self.faces)
        self.n_vertices, self.n_faces = len(self.rest), len(self.faces)
        self.scale = np.sqrt(self.shape.shares)
        self.weigh = padded(1 / self.scale)
        self._corners, self._inverse = (
            (3 * self.shape.corners).ravel().astype(np.int32),
            self.shape.inverse.ravel(),
        )
        self._poisson = MeshPoisson(self.rest, self.faces, self.shape)
        self._pull = padded(self._poisson.pull)
        self.n_pieces = self._poisson.n_components
        self._set_places()

    def _set_places(self) -> None:
        poisson = self._poisson
        self._centres = np.zeros((self.n_pieces, 3))
        poisson.centres(self.rest.ravel(), self._centres)
        shares = np.bincount(poisson.component[self.shape.corners[0]], self.shape.shares, self.n_pieces)
        # a vertex without faces counts as one of n
        shares = np.maximum(shares, 1 / self.n_vertices)
        shares /= shares.sum()
        weights = poisson.centre_weights * shares[poisson.component]
        away = self.rest - weights @ self.rest
        radius = np.sqrt(weights @ (away**2).sum(axis=1))
        self._place_scale = np.sqrt(shares)[:, None] / radius

    def frames(self, rotations: FloatArray | None = None) -> FloatArray:
        """Return the frames at rest, or turned.

        Parameters
        ----------
        rotations : (m, 3, 3) float, optional
            Rotation of every face.

        Returns
        -------
        (9 m + 3,) ndarray
            Rows: the components of the first axis, of the second and of the normal; then three ones.
        """
        frames = self.shape.frames
        return padded(frames if rotations is None else np.einsum("mij,ajm->aim", rotations, frames))

    def turned(self, V: FloatArray, frames: FloatArray, out: FloatArray) -> None:
        """Find the frames of deformed faces.

        Parameters
        ----------
        V : (n, 3) float
            Vertices, metres.
        frames : (9 m + 3,) ndarray
            Frames to stay near to where a face has no area.
        out : (9 m + 3,) ndarray
            Written, but for the last three.
        """
        V = as_floats(V, "V", (self.n_vertices, 3)).ravel()
        turn_faces(V, self._corners, self._inverse, frames, out)

    def encode(self, V: FloatArray, frames: FloatArray, z: FloatArray) -> None:
        """Write the faces and the places of one mesh.

        Parameters
        ----------
        V : (n, 3) float
            Vertices, metres.
        frames : (9 m + 3,) ndarray
            Frames from which rotations are counted.
        z : (d,) ndarray
            The first 9 m and the last 3 numbers a piece are written.
        """
        V = as_floats(V, "V", (self.n_vertices, 3)).ravel()
        encode_faces(V, self._corners, self._inverse, frames, self.scale, z)
        places = self._places(z)
        self._poisson.centres(V, places)
        places -= self._centres
        places *= self._place_scale

    def decode(self, z: FloatArray, frames: FloatArray, out: FloatArray) -> None:
        """Rebuild meshes; those of one call are solved together.

        Parameters
        ----------
        z : (T, d) float
            Coordinates, C-contiguous.
        frames : (9 m + 3,) or (T, 9 m + 3) ndarray
            Frames from which rotations are counted, the same for all vectors or not.
        out : (T, n, 3) ndarray
            Written: vertices, metres.
        """
        X = self._poisson.sides(len(z))
        columns, wide = X.reshape(-1), X.shape[1]
        step = frames.shape[-1] if frames.ndim == 2 else 0
        weigh, pull, rows = self.weigh, self._pull, self._poisson.rows
        decode_faces(z.reshape(-1), z.shape[1], frames.reshape(-1), step, weigh, pull, rows, wide, columns)
        to = self._centres[:, None] + np.stack([self._places(row) / self._place_scale for row in z], axis=1)
        self._poisson.solve(X, to.reshape(self.n_pieces, -1), out)

    def _places(self, z: FloatArray) -> FloatArray:
        """Places of the pieces (c, 3) of one vector, a view."""
        return z[-3 * self.n_pieces :].reshape(-1, 3)


def padded(rows: FloatArray) -> FloatArray:
    """Lay rows end to end, and three ones more, so that vector registers may read past the end.

    Parameters
    ----------
    rows : (..., m) float
        Rows.

    Returns
    -------
    (k + 3,) ndarray
        All k numbers, then ones.
    """
    return np.concatenate([rows.ravel(), np.ones(3)])


def as_vectors(z: FloatArray, dimension: int) -> FloatArray:
    """Check coordinates and lay them out in rows.

    Parameters
    ----------
    z : (..., d) float
        Coordinates.
    dimension : int
        What d must be.

    Returns
    -------
    (T, d) ndarray of float64
        C-contiguous.

    Raises
    ------
    ValueError
        If d is another or a value is not finite.
    """
    z = np.asarray(z, dtype=np.float64)
    rows = np.ascontiguousarray(z.reshape(-1, z.shape[-1]))
    # the sum of squares is finite only if all are, and takes half the time of asking each
    if rows.shape[1] == dimension and np.isfinite(np.vdot(rows, rows)):
        return rows
    return as_floats(rows, "z", ("T", dimension))
