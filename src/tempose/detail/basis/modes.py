"""Principal modes of residuals, rounded to steps that are as coarse as the tolerance allows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray, IntArray

_ROUNDING = 0.25
"""Part of the squared tolerance that rounding may use up; leaving out modes has the rest."""
_LARGEST = 32000


@dataclass(frozen=True, eq=False)
class DetailBasis:
    """T residuals as mixtures of K modes about their mean."""

    modes: IntArray
    """(1 + K, n, 3) int16, the mean and the modes, in steps."""
    step: float
    """Metres."""
    coordinates: FloatArray
    """(T, K) float32; residual t is ``step (modes[0] + sum_k coordinates[t, k] modes[1 + k])``."""

    @property
    def n_modes(self) -> int:
        """Number of modes K."""
        return self.coordinates.shape[1]

    def residual(self, t: int) -> FloatArray:
        """Return a residual as it was kept.

        Parameters
        ----------
        t : int
            Frame.

        Returns
        -------
        (n, 3) ndarray
            Metres.
        """
        weights = np.concatenate([[1.0], self.coordinates[t]])
        return self.step * np.tensordot(weights, self.modes, axes=1)


def compress(D: FloatArray, gram: FloatArray, tolerance: float, most: int | None = None) -> DetailBasis:
    """Keep as many modes of residuals, and as many digits of them, as a tolerance asks for.

    Parameters
    ----------
    D : (T, n, 3) float
        Residuals, metres.
    gram : (T, T) float
        Inner products of the residuals less their mean.
    tolerance : float
        Root mean square over vertices and frames of what may be lost, metres.
    most : int, optional
        At most so many modes.

    Returns
    -------
    DetailBasis
        Modes have coordinates of variance 1, so that one step serves all: what it rounds off weighs the same
        in each, and large modes get more digits than small ones.
    """
    T, n, _ = D.shape
    mean = D.mean(axis=0)
    w, U = np.linalg.eigh(gram)
    w, U = np.maximum(w[::-1], 0.0), U[:, ::-1]
    K = _enough(w, (1 - _ROUNDING) * T * n * tolerance**2, T - 1 if most is None else min(most, T - 1))
    mixing = (np.sqrt(T) * U[:, :K] / T).astype(D.dtype)
    flat = D.reshape(T, -1)
    # rows of the mixing sum to zero up to rounding, so the mean need not be taken off
    modes = np.concatenate([mean.reshape(1, -1), mixing.T @ flat])
    step = 2 * tolerance * np.sqrt(_ROUNDING / (1 + K))
    step = max(step, float(np.abs(modes).max(initial=0.0)) / _LARGEST, float(np.finfo(np.float32).tiny))
    whole = np.rint(modes / step).astype(np.int16)
    coordinates = _refit(flat, whole, step)
    return DetailBasis(whole.reshape(1 + K, n, 3), float(step), coordinates.astype(np.float32))


def _enough(w: FloatArray, allowed: float, most: int) -> int:
    """Fewest modes whose rest has at most the allowed sum of squares."""
    rest = w.sum() - np.concatenate([[0.0], np.cumsum(w)])
    floor = 1e-12 * w.sum()  # rounding is no mode
    return min(int(np.argmax(rest <= max(allowed, floor))), most)


def _refit(flat: FloatArray, whole: IntArray, step: float) -> FloatArray:
    """(T, K) coordinates that are best for the rounded modes."""
    B = (step * whole).astype(flat.dtype)
    G = (B[1:] @ B[1:].T).astype(np.float64)
    right = B[1:] @ flat.T - (B[1:] @ B[0])[:, None]
    if not len(G):
        return np.zeros((len(flat), 0))
    lift = 1e-9 * np.trace(G) / len(G)
    return np.linalg.solve(G + lift * np.eye(len(G)), right).T
