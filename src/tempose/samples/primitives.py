"""Signed distances, exact or nearly so, of the solids that characters are made of, and a brush.

Distances are negative inside, with a gradient of about one near the surface. Compiled, one point at a time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from tempose.typing import FloatArray

TABLE_ROWS = 65
"""Rows of the table of cross-sections that every loft carries."""


@njit(cache=True, error_model="numpy")
def round_cone(q: FloatArray, x: float, y: float, z: float) -> float:
    """Distance to the convex hull of two balls.

    Parameters
    ----------
    q : (8,) float
        Centre of the first ball, of the second, and their radii, metres.
    x, y, z : float
        The point.

    Returns
    -------
    float
        Signed distance, exact, metres.
    """
    bx, by, bz = q[3] - q[0], q[4] - q[1], q[5] - q[2]
    px, py, pz = x - q[0], y - q[1], z - q[2]
    l2 = bx * bx + by * by + bz * bz
    rr = q[6] - q[7]
    along = px * bx + py * by + pz * bz
    beyond = along - l2
    ox, oy, oz = px * l2 - bx * along, py * l2 - by * along, pz * l2 - bz * along
    x2 = ox * ox + oy * oy + oz * oz
    y2, z2 = along * along * l2, beyond * beyond * l2
    a2 = l2 - rr * rr
    k = np.sign(rr) * rr * rr * x2
    if np.sign(beyond) * a2 * z2 > k:
        return np.sqrt(x2 + z2) / l2 - q[7]
    if np.sign(along) * a2 * y2 < k:
        return np.sqrt(x2 + y2) / l2 - q[6]
    return (np.sqrt(x2 * a2 / l2) + along * rr) / l2 - q[6]


@njit(cache=True, error_model="numpy")
def ellipsoid(q: FloatArray, x: float, y: float, z: float) -> float:
    """Distance to an ellipsoid, of first order in the distance from its surface.

    Parameters
    ----------
    q : (15,) float
        Centre, three unit axes one after another, radii; metres.
    x, y, z : float
        The point.

    Returns
    -------
    float
        Signed distance, metres.
    """
    px, py, pz = x - q[0], y - q[1], z - q[2]
    u = (px * q[3] + py * q[4] + pz * q[5]) / q[12]
    v = (px * q[6] + py * q[7] + pz * q[8]) / q[13]
    w = (px * q[9] + py * q[10] + pz * q[11]) / q[14]
    k0 = np.sqrt(u * u + v * v + w * w)
    if k0 < 1e-9:
        return -min(q[12], q[13], q[14])
    gu, gv, gw = u / q[12], v / q[13], w / q[14]
    return k0 * (k0 - 1.0) / np.sqrt(gu * gu + gv * gv + gw * gw)


@njit(cache=True, error_model="numpy")
def swell(q: FloatArray, x: float, y: float, z: float) -> float:
    """Height of a smooth bump that fills an ellipsoid: twice differentiable, zero outside.

    Parameters
    ----------
    q : (16,) float
        Centre, three unit axes one after another, radii, height; metres, negative for a dent.
    x, y, z : float
        The point.

    Returns
    -------
    float
        How far the brush moves the surface outwards here, metres.
    """
    px, py, pz = x - q[0], y - q[1], z - q[2]
    u = (px * q[3] + py * q[4] + pz * q[5]) / q[12]
    v = (px * q[6] + py * q[7] + pz * q[8]) / q[13]
    w = (px * q[9] + py * q[10] + pz * q[11]) / q[14]
    fall = max(1.0 - u * u - v * v - w * w, 0.0)
    return q[15] * fall * fall * fall


@njit(cache=True, error_model="numpy")
def _catmull_rom(table: FloatArray, s: float, row: FloatArray) -> None:
    i = min(max(int(s), 0), TABLE_ROWS - 2)
    r = s - i
    a, b = max(i - 1, 0), min(i + 2, TABLE_ROWS - 1)
    w0 = r * (-0.5 + r * (1.0 - 0.5 * r))
    w1 = 1.0 + r * r * (-2.5 + 1.5 * r)
    w2 = r * (0.5 + r * (2.0 - 1.5 * r))
    w3 = r * r * (-0.5 + 0.5 * r)
    for c in range(row.shape[0]):
        row[c] = w0 * table[a, c] + w1 * table[i, c] + w2 * table[i + 1, c] + w3 * table[b, c]


@njit(cache=True, error_model="numpy")
def loft(q: FloatArray, table: FloatArray, row: FloatArray, x: float, y: float, z: float) -> float:
    """Distance to a straight sweep of changing superellipses, of first order near its surface.

    Parameters
    ----------
    q : (18,) float
        Origin, unit axes u, v and along, length, heights of the two caps, folds a turn, phase of the folds.
    table : (TABLE_ROWS, 8) float
        Cross-sections at equal steps: centre u, v; radii towards +u, -u, +v, -v; exponent; fold depth.
    row : (8,) float
        Scratch.
    x, y, z : float
        The point.

    Returns
    -------
    float
        Signed distance, metres.
    """
    px, py, pz = x - q[0], y - q[1], z - q[2]
    t = px * q[9] + py * q[10] + pz * q[11]
    over = min(t, 0.0) / q[13] if t < 0.0 else max(t - q[12], 0.0) / q[14]
    _catmull_rom(table, min(max(t / q[12], 0.0), 1.0) * (TABLE_ROWS - 1), row)
    u = px * q[3] + py * q[4] + pz * q[5] - row[0]
    v = px * q[6] + py * q[7] + pz * q[8] - row[1]
    fold = 1.0
    if row[7] != 0.0:
        fold = 1.0 + row[7] * np.cos(q[15] * np.arctan2(v, u) + q[16])
    ru = fold * (row[2] if u > 0.0 else row[3])
    rv = fold * (row[4] if v > 0.0 else row[5])
    n = row[6]
    au, av, at = abs(u) / ru, abs(v) / rv, abs(over)
    largest = max(au, av, at)
    if largest < 1e-6:
        return -min(ru, rv)
    # powers are what costs here: each is taken once
    au, av, at = au / largest, av / largest, at / largest
    pu = au ** (n - 1.0) if au < 1.0 else 1.0
    pv = av ** (n - 1.0) if av < 1.0 else 1.0
    pt = at ** (n - 1.0) if at > 0.0 else 0.0
    total = pu * au + pv * av + pt * at
    root = total ** (1.0 / n)
    gu, gv, gt = pu / ru, pv / rv, pt / (q[13] if t < 0.0 else q[14])
    slope = root / total * np.sqrt(gu * gu + gv * gv + gt * gt)
    return (largest * root - 1.0) / slope


@njit(cache=True, error_model="numpy")
def solid(kind: Any, q: FloatArray, table: FloatArray, row: FloatArray, x: Any, y: Any, z: Any) -> float:
    """Distance to the solid of any kind: 0 round cone, 1 ellipsoid, 2 loft.

    Parameters
    ----------
    kind : int
        Which solid.
    q, table, row : ndarray
        What that solid takes; `table` is read by lofts only.
    x, y, z : float
        The point.

    Returns
    -------
    float
        Signed distance, metres.
    """
    if kind == 0:
        return round_cone(q, x, y, z)
    if kind == 1:
        return ellipsoid(q, x, y, z)
    return loft(q, table, row, x, y, z)
