"""Descent by Guttman steps, with the memory of L-BFGS.

In the metric of ``V_ff = n I - 1 1^T`` the gradient of half the stress is minus the Guttman step, so the
plain step is steepest descent with length 1, and L-BFGS in that metric starts from it. Where the stress
curves down along the last step (a saddle), or a long step raised it, the memory is dropped; the plain step
that follows cannot raise the stress, and grows as long as the stress keeps curving down.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.signals.pose._smacof import pair_sums

_DEPTH = 8
_RELAXED = 1.9
"""Any factor below 2 lets the stress fall; 1 is the plain step."""


@numba.njit(cache=True, nogil=True)
def descend(
    D: Any, z: Any, free: Any, tolerance: float, iterations: int, history: Any
) -> tuple[int, int, float]:
    """Lower the stress of places until the Guttman step is short; the stress never rises.

    Parameters
    ----------
    D : (n, n) float64
        Target distances, of size about 1.
    z : (2, n) float64
        Places, one row a coordinate; replaced by the best ones found.
    free : (f,) int64
        Frames that may move.
    tolerance : float
        Root mean square step to stop at.
    iterations : int
        Passes over all pairs at most, 1 or more.
    history : (iterations,) float64
        Written: the stress of every accepted point.

    Returns
    -------
    passes : int
        Passes over all pairs.
    accepted : int
        Entries of `history`.
    length : float
        Root mean square Guttman step at the end.
    """
    n, f = z.shape[1], len(free)
    sums, trial = np.zeros_like(z), z.copy()
    step, last, move = np.zeros((2, f)), np.zeros((2, f)), np.zeros((2, f))
    moved, change, curvature = np.zeros((_DEPTH, 2, f)), np.zeros((_DEPTH, 2, f)), np.zeros(_DEPTH)
    count, accepted, length = 0, 0, np.inf
    t, grow, plain = 0.0, 1.0, False
    for passes in range(1, iterations + 1):
        _moved(z, free, t, move, trial)
        stress = pair_sums(D, trial[0], trial[1], sums[0], sums[1])
        if accepted > 0 and stress > history[accepted - 1]:
            if plain:
                # a plain step raises the stress by rounding only: nothing is left to gain
                return passes, accepted, length
            move[:] = step
            t, grow, count, plain = 1.0, 1.0, 0, True
            continue
        history[accepted] = stress
        accepted += 1
        z[:] = trial
        last[:] = step
        _guttman_step(z, sums, free, n - f, step)
        length = np.sqrt(np.square(step).sum() / n)
        if length <= tolerance:
            return passes, accepted, length
        if accepted > 1:
            count = _remember(t * move, last - step, n, moved, change, curvature, count)
            grow = 1.0 if count else min(2.0 * grow, 64.0)
        move[:] = step
        t, plain = _RELAXED * grow, False
        if count:
            _direction(move, moved, change, curvature, count, n)
            t = 1.0
    return iterations, accepted, length


@numba.njit(cache=True, nogil=True)
def _moved(z: Any, free: Any, t: float, move: Any, trial: Any) -> None:
    for c in range(2):
        for i in range(len(free)):
            trial[c, free[i]] = z[c, free[i]] + t * move[c, i]


@numba.njit(cache=True, nogil=True)
def _guttman_step(z: Any, sums: Any, free: Any, n_fixed: int, step: Any) -> None:
    n, f = z.shape[1], len(free)
    for c in range(2):
        if n_fixed == 0:
            mean = z[c].mean()
            for i in range(f):
                step[c, i] = sums[c, i] / n + mean - z[c, i]
            continue
        # V_fc P_c is minus the sum of the fixed places, in every row
        fixed, total = z[c].sum(), 0.0
        for i in range(f):
            fixed -= z[c, free[i]]
        for i in range(f):
            total += sums[c, free[i]] + fixed
        for i in range(f):
            step[c, i] = (sums[c, free[i]] + fixed + total / n_fixed) / n - z[c, free[i]]


@numba.njit(cache=True, nogil=True)
def _dot(a: Any, b: Any, n: int) -> float:
    """Inner product of V_ff, divided by n."""
    total = 0.0
    for c in range(2):
        ab, sa, sb = 0.0, 0.0, 0.0
        for i in range(a.shape[1]):
            ab += a[c, i] * b[c, i]
            sa += a[c, i]
            sb += b[c, i]
        total += ab - sa * sb / n
    return total


@numba.njit(cache=True, nogil=True)
def _remember(s: Any, y: Any, n: int, moved: Any, change: Any, curvature: Any, count: int) -> int:
    """Keep a pair of L-BFGS, newest first; return how many there are, 0 where the stress curves down."""
    sy = _dot(s, y, n)
    if sy <= 1e-10 * _dot(s, s, n):
        return 0
    count = min(count + 1, _DEPTH)
    for k in range(count - 1, 0, -1):
        moved[k], change[k], curvature[k] = moved[k - 1], change[k - 1], curvature[k - 1]
    moved[0], change[0], curvature[0] = s, y, sy
    return count


@numba.njit(cache=True, nogil=True)
def _direction(move: Any, moved: Any, change: Any, curvature: Any, count: int, n: int) -> None:
    """Replace a Guttman step by the step of L-BFGS."""
    parts = np.zeros(count)
    for k in range(count):
        parts[k] = _dot(moved[k], move, n) / curvature[k]
        move -= parts[k] * change[k]
    move *= curvature[0] / _dot(change[0], change[0], n)
    for k in range(count - 1, -1, -1):
        move += (parts[k] - _dot(change[k], move, n) / curvature[k]) * moved[k]
