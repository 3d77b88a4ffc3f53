"""Squared distances between inputs, a row for each group of their columns."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray


class GroupDistances:
    """What all kernels on the same inputs are made from.

    Parameters
    ----------
    X : (T, P) float
        Inputs.
    groups : (P,) int
        Group of every column, 0 to G - 1.
    """

    def __init__(self, X: FloatArray, groups: IntArray) -> None:
        self.X: FloatArray = np.asarray(X, dtype=np.float64)
        self.groups: IntArray = np.asarray(groups)
        T, G = len(self.X), int(self.groups.max(initial=-1)) + 1
        self.rows, self.columns = np.tril_indices(T, -1)
        self.squares: FloatArray = np.zeros((G, T))
        self.distances: FloatArray = np.zeros((G, len(self.rows)))
        for g in range(G):
            part = self.X[:, self.groups == g]
            self.squares[g] = np.square(part).sum(axis=1)
            part = part - part.mean(axis=0)  # for the digits of the differences
            products, squares = part @ part.T, np.square(part).sum(axis=1)
            apart = squares[:, None] + squares - 2 * products
            self.distances[g] = np.maximum(apart[self.rows, self.columns], 0.0)

    @property
    def pairs(self) -> IntArray:
        """(T (T - 1) / 2,) places of the pairs below the diagonal in a flat (T, T) matrix."""
        return self.rows * len(self.X) + self.columns
