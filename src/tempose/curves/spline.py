"""Cubic B-spline curves with values in any number of dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, CubicSpline, PPoly

from tempose._validate import as_floats, read_only
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
        object.__setattr__(self, "knots", read_only(knots))
        object.__setattr__(self, "controls", read_only(controls))

    @property
    def domain(self) -> tuple[float, float]:
        """First and last parameter."""
        return float(self.knots[3]), float(self.knots[-4])

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
        u = np.clip(np.asarray(u, dtype=np.float64), *self.domain)
        return BSpline.construct_fast(self.knots, self.controls, 3)(u, nu=derivative)


def interpolating_spline(u: FloatArray, points: FloatArray) -> Spline:
    """Return the natural cubic spline through points.

    Parameters
    ----------
    u : (n,) float
        Ascending parameters, n >= 2.
    points : (n, c) float
        Where the curve is at those parameters.

    Returns
    -------
    Spline
        With n + 2 controls.

    Raises
    ------
    ValueError
        If the parameters do not ascend or the shapes differ.
    """
    u = as_floats(u, "u", ("n",))
    points = as_floats(points, "points", (len(u), "c"))
    if len(u) < 2 or (np.diff(u) <= 0).any():
        raise ValueError(f"u must hold 2 or more ascending parameters, got {len(u)}")
    pieces = CubicSpline(u, points, bc_type="natural")
    knots = np.concatenate([[u[0]] * 3, u, [u[-1]] * 3])
    return Spline(knots, _controls(pieces, knots))


def _controls(pieces: PPoly, knots: FloatArray) -> FloatArray:
    # the blossom of the polynomial on the middle span of a control is the control itself
    k = len(knots) - 4
    at = np.clip(np.arange(k) + 1, 3, k - 1)
    mid = 0.5 * (knots[at] + knots[at + 1])
    a, b, c = (knots[np.arange(k) + i] - mid for i in (1, 2, 3))
    p, d1, d2, d3 = (pieces(mid, nu=i) for i in range(4))
    s1, s2, s3 = (a + b + c) / 3, (a * b + b * c + c * a) / 3, a * b * c
    return p + s1[:, None] * d1 + s2[:, None] * d2 / 2 + s3[:, None] * d3 / 6
