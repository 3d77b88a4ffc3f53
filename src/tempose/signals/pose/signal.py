"""The pose signal g, a thin-plate spline over the pose plane (section 2.2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
            Shape coordinates.
        """
        q = (np.asarray(p, dtype=np.float64) - self.centre) / self.radius
        s = (self.sites - self.centre) / self.radius
        r2 = np.square(q[..., None, :] - s).sum(-1)
        phi = 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))
        return phi @ self.weights + self.affine[0] + q @ self.affine[1:]
