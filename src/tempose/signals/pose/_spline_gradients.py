"""How a thin-plate spline through moving places changes: sums over pairs for its derivatives."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

_FAST = {"contract", "reassoc", "nsz"}


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def pair_tables(T: Any, U: Any, phi: Any, slope: Any) -> None:
    """Write ``phi = r^2 log r`` and ``slope``, by which its derivative is ``slope * (T - U)``.

    Parameters
    ----------
    T : (N, 2) float64
        Places.
    U : (u, 2) float64
        Sites.
    phi, slope : (N, u) float64
        Written; 0 where a place is a site.
    """
    for i in range(len(T)):
        for j in range(len(U)):
            dx, dy = T[i, 0] - U[j, 0], T[i, 1] - U[j, 1]
            r2 = dx * dx + dy * dy
            log = np.log(r2) if r2 > 0.0 else -1.0
            phi[i, j] = 0.5 * r2 * log
            slope[i, j] = log + 1.0


@numba.njit(cache=True, nogil=True, fastmath=_FAST)
def pull_back(T: Any, U: Any, slope: Any, by_phi: Any, by_place: Any, by_site: Any) -> None:
    """Take derivatives by ``phi(|T - U|)`` back to places and sites.

    Parameters
    ----------
    T : (N, 2) float64
        Places.
    U : (u, 2) float64
        Sites.
    slope : (N, u) float64
        As `pair_tables` wrote it.
    by_phi : (N, u) float64
        Derivatives of a number by phi.
    by_place : (N, 2) float64
        Added to: its derivatives by the places.
    by_site : (u, 2) float64
        Added to: its derivatives by the sites.
    """
    for i in range(len(T)):
        sx, sy = 0.0, 0.0
        for j in range(len(U)):
            along = slope[i, j] * by_phi[i, j]
            dx, dy = along * (T[i, 0] - U[j, 0]), along * (T[i, 1] - U[j, 1])
            sx += dx
            sy += dy
            by_site[j, 0] -= dx
            by_site[j, 1] -= dy
        by_place[i, 0] += sx
        by_place[i, 1] += sy
