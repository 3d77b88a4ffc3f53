"""Where the parts of a mesh stand: six numbers each, three for a loose vertex."""

from __future__ import annotations

import numpy as np

from tempose.rotations import from_matrix, from_rotation_vector, to_matrix, to_rotation_vector
from tempose.shape_spaces.edge_dihedral.parts import Part, find_parts, rigid_fit
from tempose.typing import FloatArray, IntArray

_TURN = 2 * np.pi


class Placement:
    """Rotation vector and place of every part, against a reference mesh.

    Parameters
    ----------
    V : (n, 3) float
        Reference mesh, metres.
    F : (m, 3) int
        Faces.
    weights : (n,) float
        As `steady_weights` gives them.

    Notes
    -----
    The main part, that of the largest area, is placed in the world. Every other part, and every loose
    vertex, is placed against the region of the main part that is nearest at rest, so that eyes stay in
    their head between two poses. So all coordinates but the first six are blind to rigid motion.
    Places are divided by the diagonal of the reference, rotations weighed by the radius of the part.
    """

    def __init__(self, V: FloatArray, F: IntArray, weights: FloatArray) -> None:
        self.V = V
        self.parts = find_parts(V, F, weights)
        self.starts = np.cumsum([0] + [6 if part.rigid else 3 for part in self.parts])
        self.size = float(np.linalg.norm(np.ptp(V, axis=0)))
        self.shares = [np.sqrt(len(part.vertices) / len(V)) for part in self.parts]
        self.radii = [_radius(V[part.vertices], part.weights) / self.size for part in self.parts]

    @property
    def dimension(self) -> int:
        """Number of coordinates."""
        return int(self.starts[-1])

    def encode(self, V: FloatArray) -> FloatArray:
        """Turn the places of a mesh's parts into numbers.

        Parameters
        ----------
        V : (n, 3) float
            Vertices, metres.

        Returns
        -------
        (dimension,) ndarray
            Per part: rotation vector (absent for a loose vertex), place.
        """
        out = np.zeros(self.dimension)
        for k, part in enumerate(self.parts):
            own = part.vertices
            Q, at, before = self._carrier(part, V)
            R, c, c0 = (
                rigid_fit(self.V[own], V[own], part.weights) if part.rigid else (Q, V[own[0]], self.V[own[0]])
            )
            place = ((c - at) @ Q - (c0 - before)) / self.size * self.shares[k]
            turn = to_rotation_vector(from_matrix(Q.T @ R)) * (self.radii[k] * self.shares[k])
            out[self.starts[k] : self.starts[k + 1]] = np.r_[turn, place] if part.rigid else place
        return out

    def unwrap(self, path: FloatArray) -> None:
        """Let rotation vectors go on from the frame before, in place.

        Parameters
        ----------
        path : (T, dimension) float
            Coordinates of the frames in the order of time.
        """
        for k, part in enumerate(self.parts):
            if part.rigid:
                scale = self.radii[k] * self.shares[k]
                turns = path[:, self.starts[k] : self.starts[k] + 3]
                for t in range(1, len(path)):
                    turns[t] = _nearest_branch(turns[t] / scale, turns[t - 1] / scale) * scale

    def place(self, V: FloatArray, z: FloatArray) -> FloatArray:
        """Move the parts of a mesh to where the numbers say.

        Parameters
        ----------
        V : (n, 3) float
            Vertices whose parts are right up to rigid motion.
        z : (dimension,) float
            Coordinates.

        Returns
        -------
        (n, 3) ndarray
            Placed vertices, metres.
        """
        X = np.array(V)
        for k, part in enumerate(self.parts):
            own, numbers = part.vertices, z[self.starts[k] : self.starts[k + 1]] / self.shares[k]
            Q, at, before = self._carrier(part, X)
            if part.rigid:
                found, c, c0 = rigid_fit(self.V[own], V[own], part.weights)
                R = Q @ to_matrix(from_rotation_vector(numbers[:3] / self.radii[k])) @ found.T
                X[own] = (V[own] - c) @ R.T
            else:
                X[own], c0 = 0.0, self.V[own[0]]
            X[own] += at + Q @ (c0 - before + numbers[-3:] * self.size)
        return X

    def _carrier(self, part: Part, V: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Rotation and place of what carries a part, and its place at rest; the world for the main part."""
        if len(part.anchor) == 0:
            return np.eye(3), np.zeros(3), np.zeros(3)
        return rigid_fit(self.V[part.anchor], V[part.anchor], np.ones(len(part.anchor)))


def _radius(V: FloatArray, weights: FloatArray) -> float:
    return float(np.sqrt(weights @ np.sum((V - weights @ V) ** 2, axis=1)))


def _nearest_branch(turn: FloatArray, before: FloatArray) -> FloatArray:
    """Of the vectors of one rotation that which is nearest to the one before."""
    angle = np.linalg.norm(turn)
    if angle < 1e-9:
        far = np.linalg.norm(before)
        # the rotation is nearly none: any axis will do, so that before goes on
        return turn + before / far * (np.round(far / _TURN) * _TURN) if far > 0.5 * _TURN else turn
    axis = turn / angle
    return turn + axis * (np.round((before @ axis - angle) / _TURN) * _TURN)
