"""Exact percentiles of a stream of numbers whose length is known beforehand."""

from __future__ import annotations

import math

import numpy as np

from tempose.typing import FloatArray


class UpperTail:
    """Keep only the largest numbers of a stream: enough for an exact high percentile.

    Parameters
    ----------
    total : int
        How many numbers will come in all, at least one.
    percent : float
        The percentile wanted, 0 to 100; memory is the share of numbers above it.
    """

    def __init__(self, total: int, percent: float) -> None:
        rank = (total - 1) * percent / 100
        self._keep = total - math.floor(rank)
        self._fraction = rank - math.floor(rank)
        self._tail: FloatArray = np.zeros(0)

    def add(self, values: FloatArray) -> None:
        """Take in more numbers.

        Parameters
        ----------
        values : array of float
            The next numbers, of any shape.
        """
        tail = np.concatenate([self._tail, np.ravel(values)])
        if len(tail) > self._keep:
            tail = np.partition(tail, len(tail) - self._keep)[len(tail) - self._keep :]
        self._tail = tail

    @property
    def percentile(self) -> float:
        """The percentile of all numbers, with linear interpolation as in `numpy.percentile`."""
        low, high = np.sort(self._tail)[[0, min(1, len(self._tail) - 1)]]
        return float(low + self._fraction * (high - low))

    @property
    def maximum(self) -> float:
        """The largest number."""
        return float(self._tail.max())
