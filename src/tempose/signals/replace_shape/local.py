"""Mixtures of poses region by region: each region of the target follows those of the source that move alike.

The normal equation of section 4.3 of the paper gives all of a mesh one set of multiples, so that a motion
which no mixture of whole poses shows is lost. Here every region of the target has its own set, from the same
pairs: the inner products of the source poses count most in the regions whose poses differ in the same way.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray, IntArray

SHARPNESS = (0.0, 2.0, 4.0, 8.0, 16.0)
"""Powers of the likeness of two regions that are tried; 0: all regions of the source count the same."""

RIDGES = (0.1, 0.03, 0.01, 0.003, 0.001)
"""Ridges that are tried, relative to the mean diagonal of the normal equation."""

LEAST_LIKE = 1e-3
"""Likeness below which a region counts as this little alike."""


@dataclass(frozen=True, eq=False)
class LocalMap:
    """How each region of the target follows regions of the source."""

    source: FloatArray
    """(K, N, N) inner products of the source poses in its regions."""
    weights: FloatArray
    """(L, K) how much a region of the source counts for one of the target."""
    sharpness: float
    """The power chosen."""
    ridge: float
    """The ridge chosen."""
    error: float
    """What is left of the distance of a pair to the mean of the others, which predict it, ..."""
    plain: float
    """... and what is left with all regions counting the same."""

    def multiples(self, frames: FloatArray) -> FloatArray:
        """Return multiples of the target poses.

        Parameters
        ----------
        frames : (K, T, N) float
            Inner products of meshes with the source poses in regions of the source.

        Returns
        -------
        (L, T, N) ndarray
            Multiples of the poses for each region of the target; they sum to 1.
        """
        return _multiples(self.source, self.weights, self.ridge, frames)


def fit_local_map(source: FloatArray, target: FloatArray) -> LocalMap:
    """Find which regions of the source and the target move alike, from pairs of poses.

    Parameters
    ----------
    source : (K, N, N) float
        Inner products of the source poses in its regions.
    target : (L, N, N) float
        Those of the target.

    Returns
    -------
    LocalMap
        With the ridge that predicts pairs left out best, and the least sharpness that does so no worse than
        the best one by one standard error.
    """
    found = _left_out(source, target)
    means = {key: float(errors.mean()) for key, errors in found.items()}
    best = min(means, key=lambda key: means[key])
    limit = means[best] + float(found[best].std(ddof=1)) / np.sqrt(len(found[best]))
    sharpness = min(b for b, r in found if means[b, r] <= limit)
    ridge = min(RIDGES, key=lambda r: means[sharpness, r])
    plain = min(means[0.0, r] for r in RIDGES)
    weights = _weights(source, _likeness(source, target), sharpness)
    return LocalMap(
        source, weights, sharpness, ridge, float(np.sqrt(means[sharpness, ridge])), float(np.sqrt(plain))
    )


def _likeness(source: FloatArray, target: FloatArray) -> FloatArray:
    """Compare how poses differ in regions: (L, K) cosines of centred inner products."""
    s, t = (_centred(G).reshape(len(G), -1) for G in (source, target))
    s, t = (g / np.maximum(np.linalg.norm(g, axis=1, keepdims=True), np.finfo(float).tiny) for g in (s, t))
    return np.maximum(t @ s.T, LEAST_LIKE)


def _weights(source: FloatArray, likeness: FloatArray, sharpness: float) -> FloatArray:
    alike = likeness**sharpness
    traces = np.trace(_centred(source), axis1=1, axis2=2)
    return alike / np.maximum(alike @ traces, np.finfo(float).tiny)[:, None]


def _centred(G: FloatArray) -> FloatArray:
    G = G - G.mean(axis=1, keepdims=True)
    return G - G.mean(axis=2, keepdims=True)


def _multiples(source: FloatArray, weights: FloatArray, ridge: float, frames: FloatArray) -> FloatArray:
    # about the mean pose: <z - qbar, q_j - qbar>
    n = source.shape[1]
    sides = frames - source.mean(axis=1)[:, None, :]
    sides = np.tensordot(weights, sides - sides.mean(axis=2, keepdims=True), 1)
    H = np.tensordot(weights, _centred(source), 1) + ridge / n * np.eye(n)
    a = np.linalg.solve(H, sides.transpose(0, 2, 1)).transpose(0, 2, 1)
    return a - a.mean(axis=2, keepdims=True) + 1.0 / n


def _left_out(source: FloatArray, target: FloatArray) -> Mapping[tuple[float, float], FloatArray]:
    """Return, for every pair, the squared error of predicting it, of what the others' mean leaves."""
    N = source.shape[1]
    errors = {(b, r): np.zeros(N) for b in SHARPNESS for r in RIDGES}
    for j in range(N):
        rest = np.delete(np.arange(N), j)
        some = source[:, rest][:, :, rest]
        likeness = _likeness(some, target[:, rest][:, :, rest])
        own = source[:, j, rest][:, None]
        mean = _squared(target, rest, j, np.full((len(target), N - 1), 1 / (N - 1)))
        for sharpness in SHARPNESS:
            weights = _weights(some, likeness, sharpness)
            for ridge in RIDGES:
                a = _multiples(some, weights, ridge, own)[:, 0]
                errors[sharpness, ridge][j] = _squared(target, rest, j, a) / mean
    return errors


def _squared(target: FloatArray, rest: IntArray, j: int, a: FloatArray) -> float:
    c = np.zeros((len(target), target.shape[1]))
    c[:, rest], c[:, j] = a, -1.0
    return max(float(np.sum((c[:, None] @ target)[:, 0] * c)), np.finfo(float).tiny)
