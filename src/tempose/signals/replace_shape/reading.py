"""Meshes read in terms of example poses: aligned to their mean, encoded, multiplied with them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.shape_spaces import ShapeSpace
from tempose.signals.placement import fit_placements, in_body
from tempose.signals.replace_shape.mixtures import Products
from tempose.signals.replace_shape.regions import Regions
from tempose.typing import FloatArray

AT_ONCE = 60_000_000
"""Numbers encoded at once: each block is unwrapped in time for itself, the longer the better."""


@dataclass(frozen=True, eq=False)
class Reading:
    """Meshes in terms of poses."""

    products: Products
    """Counted from the first pose."""
    regional: FloatArray
    """(K, T, N) products of the meshes with the poses region by region; one region where none were given."""
    placements: FloatArray
    """(T, 7) how each mesh stands against the mean of the poses."""


class PoseReader:
    """Reads meshes in terms of poses.

    Parameters
    ----------
    space : ShapeSpace
        Where meshes are compared.
    bodies : (N, n, 3) float
        The poses, aligned.
    regions : Regions, optional
        Multiply region by region, too.
    """

    def __init__(self, space: ShapeSpace, bodies: FloatArray, regions: Regions | None = None) -> None:
        self.space = space
        self.mean = bodies.mean(axis=0)
        encoded = space.encode(bodies)
        self._reference = encoded[0]
        self._poses = encoded - encoded[0]
        self._regions = regions

    def pose_products(self) -> FloatArray:
        """Return inner products of the poses region by region.

        Returns
        -------
        (K, N, N) ndarray
            Counted from the first pose; a single region where none were given.
        """
        if self._regions is None:
            return (self._poses @ self._poses.T)[None]
        return self._regions.products(self._poses, self._poses)

    def read(self, V: FloatArray) -> Reading:
        """Align meshes to the mean of the poses and multiply them with the poses.

        Parameters
        ----------
        V : (T, n, 3) float
            Meshes, in the order of time.

        Returns
        -------
        Reading
            What `best_mixtures` and local maps need.
        """
        placements = fit_placements(V, self.mean, rounds=1)
        step = max(2, AT_ONCE // self.space.dimension)
        regional: list[FloatArray] = []
        squares = np.zeros(len(V))
        total = np.zeros(self.space.dimension)
        for i in range(0, len(V), step):
            here = slice(i, i + step)
            z = self.space.encode_path(in_body(V[here], placements[here])) - self._reference
            squares[here] = np.square(z).sum(axis=1)
            if self._regions is None:
                regional.append((z @ self._poses.T)[None])
            else:
                regional.append(self._regions.products(z, self._poses))
            total += z.sum(axis=0)
        variation = float(squares.sum() - total @ total / len(V))
        inner = np.concatenate(regional, axis=1)
        products = Products(self._poses @ self._poses.T, inner.sum(axis=0), squares, variation)
        return Reading(products, inner, placements)
