"""The shape signal of a target whose regions have multiples of poses of their own."""

from __future__ import annotations

import numpy as np

from tempose.shape_spaces import ShapeSpace
from tempose.signals.replace_shape.regions import Regions
from tempose.signals.shape.signal import ShapeSignal
from tempose.typing import FloatArray

KEPT = 1e-4
"""Components go on until what they leave is below this part of the motion."""


class RegionalShapes:
    """Meshes by multiples of poses, region by region.

    Parameters
    ----------
    space : ShapeSpace
        Of the target.
    regions : Regions
        Of the target.
    R : (N, d) float
        Encoded target poses.
    """

    def __init__(self, space: ShapeSpace, regions: Regions, R: FloatArray) -> None:
        self._space, self._regions, self._poses = space, regions, R

    def encoded(self, a: FloatArray) -> FloatArray:
        """Return encoded meshes, or sums of differences of them.

        Parameters
        ----------
        a : (L, T, N) float
            Multiples.

        Returns
        -------
        (T, d) ndarray
            In each region the sum of its multiples of the poses, blended between regions.
        """
        T = a.shape[1]
        z = np.zeros((T, self._poses.shape[1]))
        for group, share in zip(self._regions.groups, self._regions.shares):
            poses = self._poses[:, group.columns].transpose(1, 0, 2)
            for t in range(T):
                own = share @ a[:, t]
                z[t, group.columns] = (own[:, None] @ poses)[:, 0]
        return z

    def signal(self, a: FloatArray) -> tuple[ShapeSignal, FloatArray]:
        """Find the principal components of meshes.

        Parameters
        ----------
        a : (L, T, N) float
            Multiples.

        Returns
        -------
        shape : ShapeSignal
            Orthonormal components about the mean of the meshes.
        X : (T, m) ndarray
            The meshes in its coordinates.
        """
        mean = a.mean(axis=1, keepdims=True)
        A = (a - mean).transpose(1, 0, 2).reshape(a.shape[1], -1)
        v, Q = np.linalg.eigh(self._products())
        U, s, _ = np.linalg.svd(A @ (Q * np.sqrt(np.maximum(v, 0.0))), full_matrices=False)
        left = np.sqrt(np.maximum(1.0 - np.cumsum(s**2) / max(np.square(s).sum(), np.finfo(float).tiny), 0.0))
        m = min(int(np.argmax(left <= KEPT)) + 1, max(int((s > 1e-7 * s[0]).sum()), 1))
        s = np.maximum(s[:m], np.finfo(float).tiny)
        directions = (U[:, :m] / s).T @ A
        shaped = directions.reshape(m, a.shape[0], a.shape[2]).transpose(1, 0, 2)
        shape = ShapeSignal(self._space, self.encoded(mean)[0], self.encoded(shaped))
        return shape, U[:, :m] * s

    def _products(self) -> FloatArray:
        """(L N, L N) inner products of each region's share in each pose."""
        L, N = self._regions.count, len(self._poses)
        total = np.zeros((N, N, L, L))
        for group, share in zip(self._regions.groups, self._regions.shares):
            poses = self._poses[:, group.columns]
            for i in range(N):
                for j in range(i + 1):
                    weight = (poses[i] * poses[j]).sum(axis=1)[:, None]
                    total[i, j] += (share.T @ share.multiply(weight).tocsr()).toarray()
                    total[j, i] = total[i, j]
        return total.transpose(2, 0, 3, 1).reshape(L * N, L * N)
