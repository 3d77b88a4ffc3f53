"""Questions about many points: the field, the surface nearby, whose surface it is."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.samples.field import FAR, Field, parts_near, value
from tempose.samples.parts import SWELL
from tempose.samples.primitives import solid
from tempose.typing import FloatArray, IntArray


@njit(cache=True, error_model="numpy")
def values(field: Field, V: FloatArray) -> FloatArray:
    """Field at many points.

    Parameters
    ----------
    field : Field
        The character.
    V : (n, 3) float
        Points, metres.

    Returns
    -------
    (n,) ndarray
        Field, metres.
    """
    out = np.zeros(len(V))
    N = len(field.parent)
    core, drop, near = np.zeros(N + 8), np.zeros(N), np.zeros(len(field.kind), dtype=np.int64)
    for i in range(len(V)):
        x, y, z = V[i]
        k = parts_near(field, x, y, z, 0.0, near)
        out[i] = value(field, near[:k], x, y, z, core, drop)
    return out


@njit(cache=True, error_model="numpy")
def project(field: Field, V: FloatArray, steps: int, limit: float) -> FloatArray:
    """Move points onto the surface along the gradient, and say where outwards is.

    Parameters
    ----------
    field : Field
        The character.
    V : (n, 3) float
        Points near the surface, metres; overwritten.
    steps : int
        Newton steps.
    limit : float
        Longest step, metres.

    Returns
    -------
    (n, 3) ndarray
        Unit normals.
    """
    normals = np.zeros(V.shape)
    N = len(field.parent)
    core, drop, near = np.zeros(N + 8), np.zeros(N), np.zeros(len(field.kind), dtype=np.int64)
    e = 2e-4
    for i in range(len(V)):
        k = parts_near(field, V[i, 0], V[i, 1], V[i, 2], steps * limit, near)
        for _ in range(steps):
            x, y, z = V[i]
            f0 = value(field, near[:k], x, y, z, core, drop)
            gx = (value(field, near[:k], x + e, y, z, core, drop) - f0) / e
            gy = (value(field, near[:k], x, y + e, z, core, drop) - f0) / e
            gz = (value(field, near[:k], x, y, z + e, core, drop) - f0) / e
            length = np.sqrt(gx * gx + gy * gy + gz * gz)
            if length < 1e-6:
                continue
            # where two sheets meet the gradient vanishes, and says nothing about distance
            step = min(max(f0 / max(length, 0.6), -limit), limit) / length
            V[i, 0], V[i, 1], V[i, 2] = x - step * gx, y - step * gy, z - step * gz
            normals[i, 0], normals[i, 1], normals[i, 2] = gx / length, gy / length, gz / length
    return normals


@njit(cache=True, error_model="numpy")
def mixture(field: Field, V: FloatArray, widen: float, amounts: FloatArray) -> FloatArray:
    """Mix amounts given for each part by the influences of the parts.

    Parameters
    ----------
    field : Field
        P parts.
    V : (n, 3) float
        Points near the surface, metres.
    widen : float
        Factor on every fillet radius, at most `WIDEN`: larger makes softer transitions than the surface has.
    amounts : (P, q) float
        What each part stands for.

    Returns
    -------
    (n, q) ndarray
        Averages of the rows of `amounts`, weighted by the derivative of the field with respect to each part;
        a brush stroke has no weight.
    """
    P, N = len(field.kind), len(field.parent)
    out = np.zeros((len(V), amounts.shape[1]))
    near, row, weight = np.zeros(P, dtype=np.int64), np.zeros(8), np.zeros(P)
    core, keep = np.zeros(N), np.zeros(N)
    for i in range(len(V)):
        count = parts_near(field, V[i, 0], V[i, 1], V[i, 2], 0.0, near)
        core[:] = FAR
        for a in range(count):
            _add_part(field, near[: a + 1], V[i], widen, core, weight, row)
        _node_weights(field, widen, core, keep)
        total = 0.0
        for a in range(count):
            w = weight[near[a]] * keep[field.node[near[a]]]
            if w > 0.0:
                out[i] += w * amounts[near[a]]
                total += w
        out[i] /= max(total, 1e-12)
    return out


@njit(cache=True, error_model="numpy")
def _add_part(
    field: Field,
    near: IntArray,
    p: FloatArray,
    widen: float,
    core: FloatArray,
    weight: FloatArray,
    row: FloatArray,
) -> None:
    """Blend the last part of a list into its node, and share its weight with the parts before it."""
    j = near[-1]
    weight[j] = 0.0
    if field.kind[j] == SWELL:
        return
    # taking away is adding to the outside
    sign = -1.0 if field.carve[j] else 1.0
    d = sign * solid(field.kind[j], field.data[j], field.tables[j], row, p[0], p[1], p[2])
    n, k = field.node[j], field.blend[j] * widen
    h = min(max(0.5 + 0.5 * sign * (core[n] - d) / k, 0.0), 1.0)
    if h > 0.0:
        for i in near[:-1]:
            if field.node[i] == n:
                weight[i] *= 1.0 - h
    weight[j] = h
    core[n] = sign * min(sign * core[n], sign * d) - sign * max(k - abs(core[n] - d), 0.0) ** 2 / (4.0 * k)


@njit(cache=True, error_model="numpy")
def _node_weights(field: Field, widen: float, core: FloatArray, keep: FloatArray) -> None:
    """Share of each node: from the trunk to whoever lowers the field most; no other limb has any."""
    N = len(core)
    drop, share = np.zeros(N), np.zeros(N)
    best = np.full(N, -1)
    for c in range(N - 1, 0, -1):
        p, k = field.parent[c], field.node_blend[c] * widen
        total = core[c] - drop[c]
        down = core[p] - min(core[p], total) + max(k - abs(core[p] - total), 0.0) ** 2 / (4.0 * k)
        if down > drop[p]:
            drop[p], best[p] = down, c
            share[p] = min(max(0.5 + 0.5 * (core[p] - total) / k, 0.0), 1.0)
    keep[:] = 0.0
    n, left = 0, 1.0
    while best[n] >= 0:
        keep[n] = left * (1.0 - share[n])
        left *= share[n]
        n = best[n]
    keep[n] = left
