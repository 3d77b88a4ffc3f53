"""Meshes read in terms of example poses: aligned to their mean, encoded, multiplied with them."""

from __future__ import annotations

import numpy as np

from tempose.shape_spaces import ShapeSpace
from tempose.signals.placement import fit_placements, in_body
from tempose.signals.replace_shape.mixtures import Products
from tempose.typing import FloatArray

AT_ONCE = 60_000_000
"""Numbers encoded at once: each block is unwrapped in time for itself, the longer the better."""


class PoseReader:
    """Reads meshes in terms of poses.

    Parameters
    ----------
    space : ShapeSpace
        Where meshes are compared.
    bodies : (N, n, 3) float
        The poses, aligned.
    """

    def __init__(self, space: ShapeSpace, bodies: FloatArray) -> None:
        self.space = space
        self.mean = bodies.mean(axis=0)
        encoded = space.encode(bodies)
        self._reference = encoded[0]
        self._poses = encoded - encoded[0]

    def read(self, V: FloatArray) -> tuple[Products, FloatArray]:
        """Align meshes to the mean of the poses and multiply them with the poses.

        Parameters
        ----------
        V : (T, n, 3) float
            Meshes, in the order of time.

        Returns
        -------
        products : Products
            Counted from the first pose.
        placements : (T, 7) ndarray
            How each mesh stands against the mean of the poses.
        """
        placements = fit_placements(V, self.mean, rounds=1)
        step = max(2, AT_ONCE // self.space.dimension)
        frames, squares = np.zeros((len(V), len(self._poses))), np.zeros(len(V))
        total = np.zeros(self.space.dimension)
        for i in range(0, len(V), step):
            here = slice(i, i + step)
            z = self.space.encode_path(in_body(V[here], placements[here])) - self._reference
            frames[here], squares[here] = z @ self._poses.T, np.square(z).sum(axis=1)
            total += z.sum(axis=0)
        variation = float(squares.sum() - total @ total / len(V))
        return Products(self._poses @ self._poses.T, frames, squares, variation), placements
