"""Monotone maps between two clocks.

References
----------
.. [1] Fritsch and Carlson, "Monotone piecewise cubic interpolation", SIAM Journal on Numerical Analysis
   17, 1980.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.curves._kernels import evaluate_hermite, invert_hermite
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
            object.__setattr__(self, name, read_only(np.ascontiguousarray(array)))

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
        t = np.asarray(t, dtype=np.float64)
        flat = evaluate_hermite(self.keys, self.values, self.slopes, t.reshape(-1), derivative)
        return flat.reshape(t.shape)

    def inverse(self, values: FloatArray | float) -> FloatArray:
        """Return where the map takes values.

        Parameters
        ----------
        values : (...) float
            Values; those outside the range give the ends of the domain.

        Returns
        -------
        (...) ndarray
            The first place with the value, to rounding.
        """
        values = np.asarray(values, dtype=np.float64)
        flat = invert_hermite(self.keys, self.values, self.slopes, values.reshape(-1))
        return flat.reshape(values.shape)

    def slice(self, start: float, stop: float) -> MonotoneMap:
        """Return a piece of the map, exactly.

        Parameters
        ----------
        start, stop : float
            Where the piece begins and ends, ``start < stop``, inside the domain.

        Returns
        -------
        MonotoneMap
            The same map over ``start .. stop``.

        Raises
        ------
        ValueError
            If the piece is empty or leaves the domain.
        """
        first, last = self.domain
        room = 1e-9 * (last - first)
        if not (first - room <= start < stop <= last + room):
            raise ValueError(f"a piece must lie in {first:.6g} .. {last:.6g}, got {start:.6g} .. {stop:.6g}")
        start, stop = max(start, first), min(stop, last)
        inner = self.keys[(self.keys > start + room) & (self.keys < stop - room)]
        return self._at(np.concatenate([[start], inner, [stop]]))

    def with_keys(self, at: FloatArray) -> MonotoneMap:
        """Return the same map with more keys.

        Parameters
        ----------
        at : (N,) float
            New keys; those outside the domain and those there already are left out.

        Returns
        -------
        MonotoneMap
            The same map.
        """
        first, last = self.domain
        room = 1e-9 * (last - first)
        at = np.atleast_1d(np.asarray(at, dtype=np.float64))
        at = at[(at > first) & (at < last)]
        apart = np.abs(at[:, None] - self.keys).min(axis=1) > room
        return self._at(np.union1d(self.keys, at[apart])) if apart.any() else self

    def _at(self, keys: FloatArray) -> MonotoneMap:
        # rounding may make a value fall by one unit in the last place
        values = np.maximum.accumulate(self(keys))
        return MonotoneMap(keys, values, np.maximum(self(keys, 1), 0.0))

    def shifted(self, by: float, up: float = 0.0) -> MonotoneMap:
        """Return the map moved along and up.

        Parameters
        ----------
        by : float
            Added to the keys.
        up : float, default 0
            Added to the values.

        Returns
        -------
        MonotoneMap
            ``shifted(t + by) = self(t) + up``.
        """
        return MonotoneMap(self.keys + by, self.values + up, self.slopes)

    def reversed(self) -> MonotoneMap:
        """Return the map of the clip run backwards: same domain, same range.

        Returns
        -------
        MonotoneMap
            ``reversed(first + last - t) = low + high - self(t)``.
        """
        keys, values = self.keys, self.values
        return MonotoneMap(
            (keys[0] + keys[-1]) - keys[::-1], (values[0] + values[-1]) - values[::-1], self.slopes[::-1]
        )


def monotone_map(keys: FloatArray, values: FloatArray) -> MonotoneMap:
    """Return the monotone cubic through keys and values.

    Parameters
    ----------
    keys : (K,) float
        Ascending.
    values : (K,) float
        Never falling.

    Returns
    -------
    MonotoneMap
        With the slopes of Fritsch and Carlson [1]_: three-point differences, drawn into the circle of radius
        3 wherever a piece would turn.

    References
    ----------
    .. [1] Fritsch and Carlson, SIAM Journal on Numerical Analysis 17, 1980, section 4, region S2.
    """
    keys, values = as_floats(keys, "keys", ("K",)), np.asarray(values, dtype=np.float64)
    MonotoneMap(keys, values, np.zeros(len(keys)))  # says what is wrong with them
    h = np.diff(keys)
    secants = np.diff(values) / h
    slopes = _three_point(h, secants)
    slopes[:-1][secants == 0] = 0.0
    slopes[1:][secants == 0] = 0.0
    for i in np.flatnonzero(secants > 0):
        size = np.hypot(slopes[i], slopes[i + 1])
        if size > 3 * secants[i]:
            slopes[i : i + 2] *= 3 * secants[i] / size
    return MonotoneMap(keys, values, slopes)


def _three_point(h: FloatArray, secants: FloatArray) -> FloatArray:
    if len(h) == 1:
        return np.repeat(secants, 2)
    inner = (h[1:] * secants[:-1] + h[:-1] * secants[1:]) / (h[1:] + h[:-1])
    first = secants[0] + (secants[0] - secants[1]) * h[0] / (h[0] + h[1])
    last = secants[-1] + (secants[-1] - secants[-2]) * h[-1] / (h[-1] + h[-2])
    return np.maximum(np.concatenate([[first], inner, [last]]), 0.0)
