"""The pose signal g, a thin-plate spline over the pose plane (section 2.2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.signals.pose._thin_plate import evaluate, first_derivatives, second_derivatives
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class PoseSignal:
    """``g(p) = g_0 + sum_j phi(|s_j - p|) g_j + G p`` with ``phi(r) = r^2 log r``."""

    sites: FloatArray
    """(l, 2) s_j, in units of the pose plane."""
    weights: FloatArray
    """(l, m) g_j; they sum to zero, and so do their products with the sites."""
    affine: FloatArray
    """(3, m) rows g_0, then G transposed."""
    centre: FloatArray
    """(2,) what is subtracted from places in the plane..."""
    radius: float
    """...and what they are divided by before phi: rounding depends on the scale, the function does not."""
    _scaled: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        sites = as_floats(self.sites, "sites", ("l", 2))
        weights = as_floats(self.weights, "weights", (len(sites), "m"))
        affine = as_floats(self.affine, "affine", (3, weights.shape[1]))
        centre = as_floats(self.centre, "centre", (2,))
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise ValueError(f"radius must be positive, got {self.radius}")
        arrays = {"sites": sites, "weights": weights, "affine": affine, "centre": centre}
        for name, array in arrays.items():
            object.__setattr__(self, name, read_only(np.ascontiguousarray(array)))
        # divided once: one evaluation is a few microseconds
        object.__setattr__(self, "_scaled", np.ascontiguousarray((sites - centre) / self.radius))

    def __call__(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Evaluate the pose signal.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            Ticks of the clip that the places come from; only a signal made of windows needs them.

        Returns
        -------
        (..., m) ndarray
            Shape coordinates; of each place the same bits, alone or among others.
        """
        q, shape = self._unit(p)
        out = np.zeros((len(q), self.weights.shape[1]))
        evaluate(q, self._scaled, self.weights, self.affine, out)
        return out.reshape(*shape, out.shape[1])

    def jacobian(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Return the derivatives of g by the place.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            As in a call.

        Returns
        -------
        (..., m, 2) ndarray
            By x and by y of the plane.
        """
        q, shape = self._unit(p)
        out = np.zeros((len(q), 2, self.weights.shape[1]))
        first_derivatives(q, self._scaled, self.weights, self.affine, out)
        return np.moveaxis(out, 1, 2).reshape(*shape, out.shape[2], 2) / self.radius

    def second_derivatives(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Return the second derivatives of g by the place.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane. At a site the second derivatives are infinite, as log r is: there the
            part of that site is left out.
        origin : (...) float, optional
            As in a call.

        Returns
        -------
        (..., m, 2, 2) ndarray
            Symmetric.
        """
        q, shape = self._unit(p)
        out = np.zeros((len(q), 3, self.weights.shape[1]))
        second_derivatives(q, self._scaled, self.weights, out)
        square = out[:, [0, 1, 1, 2]] / self.radius**2
        return np.moveaxis(square, 1, 2).reshape(*shape, out.shape[2], 2, 2)

    def _unit(self, p: FloatArray) -> tuple[FloatArray, tuple[int, ...]]:
        p = np.asarray(p, dtype=np.float64)
        if p.ndim == 0 or p.shape[-1] != 2:
            raise ValueError(f"p must have shape (..., 2), got {p.shape}")
        return (p.reshape(-1, 2) - self.centre) / self.radius, p.shape[:-1]
