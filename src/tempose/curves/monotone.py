"""Monotone maps between two clocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from tempose._validate import as_floats, read_only
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class MonotoneMap:
    """A never falling piecewise cubic; outside its keys it keeps its end values."""

    keys: FloatArray
    """(K,) ascending places, K >= 2."""
    values: FloatArray
    """(K,) never falling values there."""
    slopes: FloatArray
    """(K,) derivatives there."""

    def __post_init__(self) -> None:
        keys = as_floats(self.keys, "keys", ("K",))
        values = as_floats(self.values, "values", (len(keys),))
        slopes = as_floats(self.slopes, "slopes", (len(keys),))
        if len(keys) < 2 or (np.diff(keys) <= 0).any() or (np.diff(values) < 0).any():
            raise ValueError("keys must ascend and values must not fall")
        for name, array in (("keys", keys), ("values", values), ("slopes", slopes)):
            object.__setattr__(self, name, read_only(array))

    @property
    def domain(self) -> tuple[float, float]:
        """First and last key."""
        return float(self.keys[0]), float(self.keys[-1])

    def __call__(self, t: FloatArray | float, derivative: int = 0) -> FloatArray:
        """Evaluate the map or its derivative.

        Parameters
        ----------
        t : (...) float
            Places; clipped to the domain.
        derivative : int, default 0
            Order, 0 or 1.

        Returns
        -------
        (...) ndarray
            Values.
        """
        t = np.clip(np.asarray(t, dtype=np.float64), *self.domain)
        return CubicHermiteSpline(self.keys, self.values, self.slopes)(t, nu=derivative)


def monotone_map(keys: FloatArray, values: FloatArray) -> MonotoneMap:
    """Return the monotone map through keys and values.

    Parameters
    ----------
    keys : (K,) float
        Ascending.
    values : (K,) float
        Never falling.

    Returns
    -------
    MonotoneMap
        With the slopes of Fritsch and Butland.
    """
    keys, values = np.asarray(keys, dtype=np.float64), np.asarray(values, dtype=np.float64)
    return MonotoneMap(keys, values, PchipInterpolator(keys, values)(keys, nu=1))
