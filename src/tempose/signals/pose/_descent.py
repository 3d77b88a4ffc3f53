"""Descent by Guttman steps, with the memory of L-BFGS."""

from __future__ import annotations

import numpy as np

from tempose.signals.pose._smacof import pair_sums
from tempose.typing import BoolArray, FloatArray

_DEPTH = 8


class GuttmanDescent:
    """Minimises the stress of places in the plane; the stress of accepted places never rises.

    Parameters
    ----------
    D : (n, n) float
        Target distances, of size about 1.
    z : (2, n) float
        Where to start, one row a coordinate.
    free : (n,) bool
        Frames that may move.

    Notes
    -----
    In the metric of ``V_ff = n I - 1 1^T`` the gradient of half the stress is minus the Guttman step, so the
    plain step is steepest descent with step length 1, and L-BFGS in that metric starts from it. Where the
    stress curves down along the last step (a saddle) or a long step raised it, the memory is dropped; the
    plain step that follows cannot raise the stress, and grows as long as the stress keeps curving down.
    """

    def __init__(self, D: FloatArray, z: FloatArray, free: BoolArray) -> None:
        self.D, self.best, self.free = D, np.ascontiguousarray(z), free
        self.n_fixed = len(free) - int(free.sum())
        self.history: list[float] = []
        """Stress at every accepted point."""
        self.passes = 0
        self.step = np.inf
        """Root mean square length of the Guttman step at `best`."""
        self._memory: list[tuple[FloatArray, FloatArray, float]] = []

    def run(self, tolerance: float, iterations: int) -> None:
        """Descend until the step is within the tolerance or the passes are spent.

        Parameters
        ----------
        tolerance : float
            Length of a Guttman step to stop at.
        iterations : int
            Passes over all pairs, at least one is made.
        """
        step, grow, t, move = np.zeros_like(self.best), 1.0, 0.0, np.zeros_like(self.best)
        sums = np.zeros_like(self.best)
        while self.passes < max(iterations, 1):
            z = self.best + t * move
            stress = pair_sums(self.D, z[0], z[1], sums[0], sums[1])
            self.passes += 1
            if self.history and stress > self.history[-1]:
                if t <= 1.0 and move is step:
                    break  # the plain step raises the stress by rounding only: nothing is left to gain
                self._memory.clear()
                move, t, grow = step, 1.0, 1.0
                continue
            self.history.append(stress)
            last, step = step, self._guttman_step(z, sums)
            self.best = z
            self.step = float(np.sqrt(np.square(step).sum() / len(self.free)))
            if self.step <= tolerance:
                break
            curved = t == 0.0 or self._remember(t * move, last - step)
            grow = 1.0 if curved else min(2.0 * grow, 64.0)
            move, t = (self._direction(step), 1.0) if self._memory else (step, 1.9 * grow)

    def _guttman_step(self, z: FloatArray, sums: FloatArray) -> FloatArray:
        n, step = z.shape[1], np.zeros_like(z)
        if self.n_fixed == 0:
            return sums / n + z.mean(axis=1, keepdims=True) - z
        # V_fc P_c is minus the sum of the fixed places, in every row
        right = sums[:, self.free] + z[:, ~self.free].sum(axis=1, keepdims=True)
        moved = (right + right.sum(axis=1, keepdims=True) / self.n_fixed) / n
        step[:, self.free] = moved - z[:, self.free]
        return step

    def _dot(self, a: FloatArray, b: FloatArray) -> float:
        n = a.shape[1]
        return float((a * b).sum() - (a.sum(axis=1) * b.sum(axis=1)).sum() / n)

    def _remember(self, moved: FloatArray, change: FloatArray) -> bool:
        """Keep a pair of L-BFGS; without upward curvature forget all and return False."""
        curvature = self._dot(moved, change)
        if curvature <= 1e-10 * self._dot(moved, moved):
            self._memory.clear()
            return False
        self._memory = [*self._memory[1 - _DEPTH :], (moved, change, curvature)]
        return True

    def _direction(self, step: FloatArray) -> FloatArray:
        direction = step.copy()
        parts: list[float] = []
        for moved, change, curvature in reversed(self._memory):
            parts.append(self._dot(moved, direction) / curvature)
            direction -= parts[-1] * change
        _, change, curvature = self._memory[-1]
        direction *= curvature / self._dot(change, change)
        for (moved, change, curvature), part in zip(self._memory, reversed(parts)):
            direction += (part - self._dot(change, direction) / curvature) * moved
        return direction
