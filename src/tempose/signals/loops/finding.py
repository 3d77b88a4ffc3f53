"""Pairs of frames between which a clip can be played again and again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray, IntArray

EXACT, GOOD, GOOD_VELOCITY = 0.01, 0.75, 0.5
FILM = 24.0
"""Frames per second up to which a step is one frame."""

SHORTEST = 6
"""Steps that a loop takes at least, if nothing is said."""

QUIET = 1.0
"""Weight of the speed at the seam, in mean speeds, beside distance and change of velocity."""

_SIDE = 2  # frames on either side that are compared, too


@dataclass(frozen=True)
class Loop:
    """Frame `stop` looks like frame `start` and moves like it: after frame `stop - 1` comes `start` again."""

    start: int
    """First frame."""
    stop: int
    """The frame that the first one stands for."""
    distance: float
    """How far the two are apart, with the frames beside them, in mean steps."""
    velocity: float
    """How far their velocities are apart, in mean speeds."""

    @property
    def period(self) -> int:
        """Frames after which the loop begins anew."""
        return self.stop - self.start

    @property
    def cost(self) -> float:
        """How badly it comes back."""
        return self.distance + self.velocity

    @property
    def grade(self) -> str:
        """Exact, good, or needs a transition."""
        if self.distance < EXACT and self.velocity < EXACT:
            return "exact"
        good = self.distance < GOOD and self.velocity < GOOD_VELOCITY
        return "good" if good else "needs a transition"


def find_loops(X: FloatArray, shortest: int | None = None, most: int = 8, *, fps: float = FILM) -> list[Loop]:
    """Find loops in a clip.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames, without where the body is if it travels.
    shortest : int, optional
        Least number of frames in a loop; None means a quarter of a second, 6 at 24 frames per second.
    most : int, default 8
        How many to return.
    fps : float, default 24
        Frames per second. Above 24 a step is the mean motion in 1/24 s, so that what is a good loop does not
        depend on how densely it was captured.

    Returns
    -------
    list of Loop
        The best grade first, in it the least sum of distance, velocity and speed at the seam, since a seam is
        seen least where least moves; of loops that begin and end within two steps of each other only the
        best. A part of the clip in which
        hardly anything moves is none, nor is one that ends farther from its begin than its poses lie from
        their mean.

    Raises
    ------
    ValueError
        If `shortest` or `most` is less than 1, or `fps` is not positive.
    """
    X = as_floats(X, "X", ("n", "m"))
    if not fps > 0:
        raise ValueError(f"fps must be positive, got {fps}")
    wide = max(1, round(fps / FILM))
    shortest = SHORTEST * wide if shortest is None else shortest
    if shortest < 1 or most < 1:
        raise ValueError(f"shortest and most must be 1 or more, got {shortest} and {most}")
    n = len(X)
    if n <= shortest:
        return []
    X = _reduced(X)
    # at the ends of the clip too as exact as inside, for clips that end where they begin
    velocity = np.gradient(X, axis=0, edge_order=2 if n > 2 else 1)
    step = wide * float(np.linalg.norm(np.diff(X, axis=0), axis=1).mean())
    speed = float(np.linalg.norm(velocity, axis=1).mean())
    if step == 0 or speed == 0:
        return []
    apart = np.sqrt(_windowed(_squared(X))) / step
    turned = np.sqrt(_squared(velocity)) / speed
    turned[0, -1] = min(turned[0, -1], _jolt(X) / speed + apart[0, -1])
    start, stop = np.triu_indices(n, shortest)
    one, other = apart[start, stop], turned[start, stop]
    travels = _spread(X, start, stop) > step * np.maximum(1.0, one)
    # twins leave no seam: among them speed only settles which is named
    quiet = np.linalg.norm(velocity, axis=1) / speed
    exact = (one < EXACT) & (other < EXACT)
    cost = one + other + np.where(exact, 1e-3, QUIET) * quiet[start]
    good = (one < GOOD) & (other < GOOD_VELOCITY)
    order = np.lexsort((cost, ~good, ~exact))
    order = order[travels[order]][: 400 * most * wide]
    found = [Loop(int(start[i]), int(stop[i]), float(one[i]), float(other[i])) for i in order]
    return _distinct(found, most, 2 * wide)


def _jolt(X: FloatArray) -> float:
    # by how much velocity changes across the seam of the whole clip beyond what it does inside: one-sided
    # velocities at its ends tell less
    bends = np.linalg.norm(np.diff(np.concatenate([X, X[1:2]]), 2, axis=0), axis=1)
    return max(0.0, float(bends[-1] - bends[:-1].max(initial=0.0)))


def _reduced(X: FloatArray) -> FloatArray:
    # distances are all that counts: as many columns as frames tell them
    X = X - X.mean(0)
    if X.shape[1] <= len(X):
        return X
    w, U = np.linalg.eigh(X @ X.T)
    return U * np.sqrt(np.maximum(w, 0.0))


def _squared(X: FloatArray) -> FloatArray:
    # differences, not the Gram matrix: twins shall be exactly 0 apart
    out = np.zeros((len(X), len(X)))
    for i in range(len(X)):
        out[i] = np.square(X - X[i]).sum(1)
    return out


def _windowed(squared: FloatArray) -> FloatArray:
    # mean over the frames beside both, as far as the clip has them
    n = len(squared)
    total, count = np.zeros((n, n)), np.zeros((n, n))
    for k in range(-_SIDE, _SIDE + 1):
        low, high = max(0, -k), n - max(0, k)
        total[low:high, low:high] += squared[low + k : high + k, low + k : high + k]
        count[low:high, low:high] += 1
    return total / count


def _spread(X: FloatArray, start: IntArray, stop: IntArray) -> FloatArray:
    # rms distance of the frames of a loop to their mean, by running sums
    sums = np.concatenate([np.zeros((1, X.shape[1])), np.cumsum(X, axis=0)])
    squares = np.concatenate([[0.0], np.cumsum(np.square(X).sum(1))])
    count = stop - start
    mean = (sums[stop] - sums[start]) / count[:, None]
    return np.sqrt(np.maximum((squares[stop] - squares[start]) / count - np.square(mean).sum(1), 0.0))


def _distinct(loops: list[Loop], most: int, beside: int) -> list[Loop]:
    kept: list[Loop] = []
    for loop in loops:
        if all(max(abs(loop.start - k.start), abs(loop.stop - k.stop)) > beside for k in kept):
            kept.append(loop)
        if len(kept) == most:
            break
    return kept
