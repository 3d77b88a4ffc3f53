"""The loop over trial periods: how well the frames near in phase predict each frame."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray

_SIDE = 5  # neighbours on either side: what lies further counts less than a thousandth


@njit(cache=True)
def phase_errors(X: FloatArray, periods: FloatArray, same: float, whole: bool) -> FloatArray:
    """Return how far frames lie from the cubic through the frames near them in phase.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates, a frame a tick.
    periods : (Q,) float
        Trial periods, ticks.
    same : float
        Ticks; frames nearer than this in phase are one place of the cycle.
    whole : bool
        Whether the frames of one place are left out together: else a twin gives a frame away.

    Returns
    -------
    (Q,) ndarray
        Root mean square over the frames, each left out in turn.
    """
    n, m = X.shape
    out = np.full(len(periods), np.inf)
    ticks = np.arange(n).astype(np.float64)
    for q in range(len(periods)):
        phases = ticks % periods[q]
        order = np.argsort(phases)
        group, at, mean, count = _grouped(X, phases, order, same)
        if len(at) < 4:
            continue
        total = 0.0
        for r in range(n):
            i, own = order[r], group[r]
            alone = whole or count[own] == 1
            nodes, shifts = _around(own, len(at), alone)
            weights = natural_weights(at[nodes] + shifts * periods[q], phases[i])
            for d in range(m):
                off = X[i, d]
                for j in range(len(nodes)):
                    value = mean[nodes[j], d]
                    if nodes[j] == own:  # the others of its group, without itself
                        value = (value * count[own] - X[i, d]) / (count[own] - 1)
                    off -= weights[j] * value
                total += off * off
        out[q] = np.sqrt(total / n)
    return out


@njit(cache=True)
def _grouped(
    X: FloatArray, phases: FloatArray, order: IntArray, same: float
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    n, m = X.shape
    group = np.zeros(n, dtype=np.int64)
    for r in range(1, n):
        group[r] = group[r - 1] + (1 if phases[order[r]] - phases[order[r - 1]] > same else 0)
    size = group[-1] + 1
    at, mean, count = np.zeros(size), np.zeros((size, m)), np.zeros(size)
    for r in range(n):
        at[group[r]] += phases[order[r]]
        count[group[r]] += 1
        for d in range(m):
            mean[group[r], d] += X[order[r], d]
    for g in range(size):
        at[g] /= count[g]
        for d in range(m):
            mean[g, d] /= count[g]
    return group, at, mean, count


@njit(cache=True)
def _around(own: int, size: int, alone: bool) -> tuple[IntArray, FloatArray]:
    # groups round about, in order, and how many periods each is away
    side = min(_SIDE, (size - 1) // 2)
    nodes, shifts = np.zeros(2 * side + 1, dtype=np.int64), np.zeros(2 * side + 1)
    found = 0
    for step in range(-side, side + 1):
        if step == 0 and alone:
            continue
        nodes[found] = (own + step) % size
        shifts[found] = (own + step) // size
        found += 1
    return nodes[:found], shifts[:found]


@njit(cache=True)
def natural_weights(t: FloatArray, x: float) -> FloatArray:
    """Return what the points of a natural cubic spline weigh at a place.

    Parameters
    ----------
    t : (n,) float
        Ascending parameters.
    x : float
        Between the first and the last.

    Returns
    -------
    (n,) ndarray
        Weights; they sum to 1.
    """
    n = len(t)
    out = np.zeros(n)
    i = min(max(np.searchsorted(t, x) - 1, 0), n - 2)
    h = t[i + 1] - t[i]
    b = (x - t[i]) / h
    a = 1 - b
    out[i], out[i + 1] = a, b
    if n < 3:
        return out
    # second derivatives M solve a tridiagonal system; its transpose gives the weights in one solve
    right = np.zeros(n)
    right[i], right[i + 1] = (a**3 - a) * h * h / 6, (b**3 - b) * h * h / 6
    right[0] = right[n - 1] = 0.0
    steps = t[1:] - t[:-1]
    pivot, z = np.zeros(n), np.zeros(n)
    for j in range(1, n - 1):
        pivot[j] = (steps[j - 1] + steps[j]) / 3
        z[j] = right[j]
        if j > 1:
            share = steps[j - 1] / 6 / pivot[j - 1]
            pivot[j] -= share * steps[j - 1] / 6
            z[j] -= share * z[j - 1]
    for j in range(n - 2, 0, -1):
        if j < n - 2:
            z[j] -= steps[j] / 6 * z[j + 1]
        z[j] /= pivot[j]
        out[j - 1] += z[j] / steps[j - 1]
        out[j] -= z[j] * (1 / steps[j - 1] + 1 / steps[j])
        out[j + 1] += z[j] / steps[j]
    return out
