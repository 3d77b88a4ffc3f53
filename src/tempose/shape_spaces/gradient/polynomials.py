"""Polynomials in place of trigonometric functions, which would not run in vector registers."""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from tempose.typing import FloatArray

LEAST_COSINE = -0.95
"""Rotations further than this (162 degrees) take the slow way: the sine no longer tells the axis."""


def fitted(f: Callable[[FloatArray], FloatArray], upper: float, degree: int) -> tuple[float, ...]:
    """Fit a polynomial at Chebyshev points, to rounding.

    Parameters
    ----------
    f : callable
        Smooth function of an array.
    upper : float
        End of the interval, which starts at 0.
    degree : int
        Degree.

    Returns
    -------
    tuple of float
        Coefficients, the constant first.
    """
    found = Chebyshev.interpolate(f, degree, domain=[0.0, upper]).convert(kind=Polynomial)
    return tuple(float(c) for c in found.coef)


def _arctangent(x: FloatArray) -> FloatArray:
    y = np.sqrt(x)
    return np.arctan(y) / y


# tan^2 of a quarter of the largest angle
_QUARTER = float(np.tan(np.arccos(LEAST_COSINE) / 4) ** 2)

ARCTANGENT = fitted(_arctangent, _QUARTER, 19)
"""``atan(y) / y`` in ``y^2``."""
SINE = tuple((-1) ** k / factorial(2 * k + 1) for k in range(11))
"""``sin(r) / r`` in ``r^2``, r up to a right angle."""
COSINE = tuple((-1) ** k / factorial(2 * k) for k in range(12))
"""``cos(r)`` in ``r^2``, r up to a right angle."""
