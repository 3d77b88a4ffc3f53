"""The inner loop of multidimensional scaling: one pass over all pairs of frames."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

# summing in any order is what lets the loop over j run in vector lanes
_FAST = {"contract", "reassoc", "arcp", "nsz"}


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def pair_sums(D: Any, x: Any, y: Any, sum_x: Any, sum_y: Any) -> float:
    """Return the stress and the sums ``sum_j delta_ij (p_i - p_j) / d_ij`` of every frame.

    Parameters
    ----------
    D : (n, n) float
        Target distances delta, of size about 1; only the part below the diagonal is read.
    x, y : (n,) float
        Places p.
    sum_x, sum_y : (n,) float
        Written: the rows of ``B(P) P`` of the Guttman transform; a pair at one place adds nothing.

    Returns
    -------
    float
        ``sum_{i > j} (delta_ij - d_ij)^2``.
    """
    stress = 0.0
    sum_x[:] = 0.0
    sum_y[:] = 0.0
    for i in range(len(x)):
        xi, yi = x[i], y[i]
        sx, sy = 0.0, 0.0
        for j in range(i):
            dx, dy = xi - x[j], yi - y[j]
            d = np.sqrt(dx * dx + dy * dy)
            error = D[i, j] - d
            stress += error * error
            # 1e-150 only keeps 0 / 0 finite: dx and dy are 0 then
            ratio = D[i, j] / max(d, 1e-150)
            sx += ratio * dx
            sy += ratio * dy
            sum_x[j] -= ratio * dx
            sum_y[j] -= ratio * dy
        sum_x[i] += sx
        sum_y[i] += sy
    return stress
