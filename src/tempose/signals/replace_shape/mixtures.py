"""Frames as mixtures of example poses: the normal equation of section 4.3 of the paper."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np

from tempose.typing import FloatArray

SUBSETS = 5000
"""So many choices of pairs are all tried; where there are more, the worst pair is left out one at a time."""


@dataclass(frozen=True, eq=False)
class Mixtures:
    """Frames written as the first pose plus multiples of the others' differences to it."""

    used: tuple[int, ...]
    """Poses that take part, ascending; the first is the reference."""
    coordinates: FloatArray
    """(T, m) multiples of ``q_j - q_0``, m one less than poses used."""
    residual: float
    """Root of what is left of the frames over their variation about their mean; 0: the poses show all."""
    condition: float
    """Condition number of the normal equation."""


@dataclass(frozen=True, eq=False)
class Products:
    """Inner products of poses and frames in shape space, counted from the first pose."""

    poses: FloatArray
    """(N, N) of poses with poses."""
    frames: FloatArray
    """(T, N) of frames with poses."""
    squares: FloatArray
    """(T,) of frames with themselves."""
    variation: float
    """Sum of the squared distances of the frames to their mean."""

    def mix(self, used: tuple[int, ...], ridge: float = 0.0) -> Mixtures:
        """Solve the normal equation for some of the poses.

        Parameters
        ----------
        used : tuple of int
            Which, ascending.
        ridge : float, default 0
            Added to the diagonal, relative to its mean: pulls the frames to the first pose used.

        Returns
        -------
        Mixtures
            Of these poses.
        """
        r, rest = used[0], list(used[1:])
        H = (
            self.poses[np.ix_(rest, rest)]
            - self.poses[rest, r][:, None]
            - self.poses[r, rest]
            + self.poses[r, r]
        )
        sides = self.frames[:, rest] - self.frames[:, [r]] - self.poses[r, rest] + self.poses[r, r]
        squares = self.squares - 2 * self.frames[:, r] + self.poses[r, r]
        damped = H + ridge * np.trace(H) / len(rest) * np.eye(len(rest))
        x = np.linalg.solve(damped, sides.T).T
        left = squares - 2 * (x * sides).sum(axis=1) + ((x @ H) * x).sum(axis=1)
        share = max(float(left.sum()), 0.0) / max(self.variation, np.finfo(float).tiny)
        return Mixtures(used, x, float(np.sqrt(share)), float(np.linalg.cond(damped)))


def best_mixtures(products: Products, count: int, ridge: float = 0.0) -> Mixtures:
    """Choose the poses whose mixtures come nearest to the frames.

    Parameters
    ----------
    products : Products
        Of all poses.
    count : int
        How many to use.
    ridge : float, default 0
        See `Products.mix`.

    Returns
    -------
    Mixtures
        Of the chosen poses.
    """
    used = tuple(range(len(products.poses)))
    while len(used) > count and comb(len(used), count) > SUBSETS:
        used = _best(products, list(combinations(used, len(used) - 1)), ridge).used
    return _best(products, list(combinations(used, count)), ridge)


def _best(products: Products, choices: list[tuple[int, ...]], ridge: float) -> Mixtures:
    return min((products.mix(used, ridge) for used in choices), key=lambda mixtures: mixtures.residual)
