"""Cubic B-spline curves with values in any number of dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.curves._kernels import evaluate_spline
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Spline:
    """A cubic B-spline curve; outside its domain it keeps its end values."""

    knots: FloatArray
    """(k + 4,) never falling knots, the ends fourfold."""
    controls: FloatArray
    """(k, c) control points, k >= 4."""

    def __post_init__(self) -> None:
        controls = as_floats(self.controls, "controls", ("k", "c"))
        knots = as_floats(self.knots, "knots", (len(controls) + 4,))
        if len(controls) < 4 or (np.diff(knots) < 0).any() or not knots[-4] > knots[3]:
            raise ValueError(
                "knots must not fall, must span an interval and belong to 4 or more controls, "
                f"got {len(controls)} controls over {knots[0]:.6g} .. {knots[-1]:.6g}"
            )
        object.__setattr__(self, "knots", read_only(np.ascontiguousarray(knots)))
        object.__setattr__(self, "controls", read_only(np.ascontiguousarray(controls)))

    @property
    def domain(self) -> tuple[float, float]:
        """First and last parameter."""
        return float(self.knots[3]), float(self.knots[-4])

    @property
    def breaks(self) -> FloatArray:
        """(K,) the different knots of the domain, ascending: between them the curve is one cubic."""
        return np.unique(self.knots[3 : len(self.knots) - 3])

    def __call__(self, u: FloatArray | float, derivative: int = 0) -> FloatArray:
        """Evaluate the curve or a derivative.

        Parameters
        ----------
        u : (...) float
            Parameters; clipped to the domain.
        derivative : int, default 0
            Order, 0 to 3.

        Returns
        -------
        (..., c) ndarray
            Points of the curve, or derivatives by the parameter.
        """
        u = np.asarray(u, dtype=np.float64)
        points = evaluate_spline(self.knots, self.controls, u.reshape(-1), derivative)
        return points.reshape(*u.shape, self.controls.shape[1])

    def support(self, j: int) -> tuple[float, float]:
        """Return between which parameters a control point has a say; outside, moving it changes no bit.

        Parameters
        ----------
        j : int
            Index of the control.

        Returns
        -------
        tuple of float
            First and last parameter of its support, inside the domain.

        Raises
        ------
        ValueError
            If there is no such control.
        """
        if not 0 <= j < len(self.controls):
            raise ValueError(f"control must be 0 to {len(self.controls) - 1}, got {j}")
        first, last = self.domain
        return max(float(self.knots[j]), first), min(float(self.knots[j + 4]), last)

    def with_controls(self, controls: FloatArray) -> Spline:
        """Return the curve with other control points over the same knots.

        Parameters
        ----------
        controls : (k, c) float
            Control points.

        Returns
        -------
        Spline
            The new curve.
        """
        return Spline(self.knots, controls)

    def shifted(self, by: float) -> Spline:
        """Return the curve with its parameters moved along.

        Parameters
        ----------
        by : float
            Added to every parameter.

        Returns
        -------
        Spline
            ``shifted(u + by) = self(u)``.
        """
        return self if by == 0 else Spline(self.knots + by, self.controls)

    def reversed(self) -> Spline:
        """Return the curve run backwards over the same domain.

        Returns
        -------
        Spline
            ``reversed(first + last - u) = self(u)``.
        """
        first, last = self.domain
        return Spline((first + last) - self.knots[::-1], self.controls[::-1])
