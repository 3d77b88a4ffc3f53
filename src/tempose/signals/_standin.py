"""Simplest layout, sites and time signal, until their own modules stand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.curves import Spline, interpolating_spline, monotone_map
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray, IntArray


def layout(X: FloatArray, pins: dict[int, tuple[float, float]]) -> FloatArray:
    """SMACOF from the first two columns."""
    P = np.zeros((len(X), 2))
    P[:, : min(2, X.shape[1])] = X[:, :2]
    D = np.linalg.norm(X[:, None] - X[None], axis=2)
    for frame, place in pins.items():
        P[frame] = place
    for _ in range(200):
        d = np.linalg.norm(P[:, None] - P[None], axis=2)
        B = np.where(d > 0, -D / np.where(d > 0, d, 1), 0)
        np.fill_diagonal(B, 0)
        np.fill_diagonal(B, -B.sum(1))
        P = B @ P / len(X)
        for frame, place in pins.items():
            P[frame] = place
    return P


def fit_pose(P: FloatArray, X: FloatArray, sites: IntArray) -> PoseSignal:
    """Least squares under the side conditions."""
    c = P.mean(0)
    r = float(np.sqrt(np.square(P - c).sum(1).mean())) or 1.0
    S, Q = (P[sites] - c) / r, (P - c) / r
    A = np.c_[np.ones(len(S)), S]
    q, _ = np.linalg.qr(A, mode="complete")
    N = q[:, 3:]
    r2 = np.square(Q[:, None] - S[None]).sum(-1)
    phi = 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))
    B = np.c_[phi @ N, np.ones(len(Q)), Q]
    c2 = np.linalg.lstsq(B, X, rcond=None)[0]
    return PoseSignal(P[sites], N @ c2[:-3], c2[-3:], c, r)


@dataclass(frozen=True)
class Order:
    """All frames in turn."""

    P: FloatArray
    X: FloatArray

    @property
    def errors(self) -> FloatArray:
        """(n + 1,) squared residuals."""
        n = len(self.P)
        return np.array(
            [np.inf] * 3 + [np.square(self.signal(l)(self.P) - self.X).sum() for l in range(3, n + 1)]
        )

    def signal(self, l: int) -> PoseSignal:
        """Fit."""
        sites = np.unique(np.linspace(0, len(self.P) - 1, l).round().astype(int))
        return fit_pose(self.P, self.X, sites)


def fit_time(P: FloatArray, k: int) -> TimeSignal:
    """Centripetal, least squares; natural at k = n + 2."""
    n = len(P)
    step = np.sqrt(np.linalg.norm(np.diff(P, axis=0), axis=1))
    mean = step.mean()
    step = np.maximum(step, 1e-3 * mean) if mean > 0 else np.ones(n - 1)
    t = np.r_[0, np.cumsum(step)]
    if k >= n + 2:
        f = interpolating_spline(t, P)
    else:
        d = (n - 1) / (k - 3)
        inner = np.interp(np.arange(1, k - 3) * d, np.arange(n), t)
        knots = np.r_[[t[0]] * 4, inner, [t[-1]] * 4]
        from scipy.interpolate import BSpline

        B = BSpline.design_matrix(t, knots, 3).toarray()
        f = Spline(knots, np.linalg.lstsq(B, P, rcond=None)[0])
    return TimeSignal(f, f, monotone_map(np.arange(n), t))


def path(X: FloatArray) -> Spline:
    """Natural cubic over frames."""
    return interpolating_spline(np.arange(float(len(X))), X)
