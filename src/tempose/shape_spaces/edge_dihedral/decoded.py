"""A mesh built from coordinates, with measures of the fit."""

from __future__ import annotations

from dataclasses import dataclass

from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Decoded:
    """A mesh and how well it fits the coordinates it was made from."""

    vertices: FloatArray
    """(n, 3) metres."""
    distance: float
    """Distance of its own coordinates to those wanted, places left out; about the rms strain between them."""
    mismatch: float
    """Root mean square of the angles by which neighbouring faces disagree at first, radians."""
    n_iter: int
    """Gauss-Newton steps taken."""
    converged: bool
    """Whether the last step gained less than 1 %, or none was needed."""
