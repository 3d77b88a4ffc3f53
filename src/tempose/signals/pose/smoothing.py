"""Frames moved in the pose plane until the pose signal follows the motion between them."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.optimize import minimize

from tempose.curves import interpolating_spline, monotone_map
from tempose.signals.pose._smacof import pair_sums
from tempose.signals.pose._spline_gradients import pair_tables, pull_back
from tempose.signals.pose.basis import plane_of
from tempose.signals.pose.merging import merge_places
from tempose.signals.pose.middles import QUARTERS, middles_of
from tempose.signals.pose.transitions import step_sizes
from tempose.signals.time.parameters import centripetal_parameters
from tempose.signals.time.path import time_path
from tempose.typing import FloatArray, IntArray

_WEIGHT = 1.0
"""Of the mean logarithm of deviations against the stress."""

_ROUNDS, _STEPS = 4, 25


def smooth_transitions(P: FloatArray, X: FloatArray, distances: FloatArray, fixed: IntArray) -> FloatArray:
    """Lower the deviations between frames by moving the frames, staying near a layout's distances.

    Parameters
    ----------
    P : (n, 2) float
        Places to start from.
    X : (n, m) float
        Shape coordinates of the frames.
    distances : (n, n) float
        Distances that the places should keep.
    fixed : (c,) int
        Frames that stay where they are.

    Returns
    -------
    (n, 2) ndarray
        Places with a lower sum of stress and ``mean log(1 + deviation^2)``, deviation in steps at quarters
        of the intervals. The logarithm lets go of what cannot be helped, such as the crossing of two motions.

    Notes
    -----
    The deviations are those of the interpolating spline, whose weights solve a system that depends on the
    places: the gradient takes one more solution of the same system. Parameters of the curve are renewed a
    few times and held between.
    """
    return _Smoothing(P, X, distances, fixed).run()


def main_columns(X: FloatArray) -> FloatArray:
    """Leave out the shape coordinates that are too small to matter for transitions.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates, the columns by falling size.

    Returns
    -------
    (n, m') ndarray
        The first columns; what is left out is within a tenth of the mean step, root mean square.
    """
    tail = np.sqrt(np.cumsum(np.square(X).mean(axis=0)[::-1])[::-1])
    return np.ascontiguousarray(X[:, : max(int((tail > 0.1 * step_sizes(X).mean()).sum()), 1)])


class _Smoothing:
    def __init__(self, P: FloatArray, X: FloatArray, distances: FloatArray, fixed: IntArray) -> None:
        places = merge_places(P, X)
        self.P, self.group, self.values = P, places.group, np.ascontiguousarray(places.values)
        self.plane = plane_of(places.positions)
        self.start = self.plane(places.positions)
        self.D = np.ascontiguousarray(distances / self.plane.radius)
        self.total = 0.5 * float(np.square(self.D).sum())
        self.free = np.ones(len(self.start), dtype=np.bool_)
        self.free[self.group[fixed]] = False
        n = len(P)
        self.ticks = middles_of(np.arange(n - 1))
        self.path = time_path(X)(self.ticks)
        self.steps = np.repeat(step_sizes(X), len(QUARTERS))[:, None]
        self.curve = np.zeros((len(self.ticks), n))

    def run(self) -> FloatArray:
        U = self.start.copy()
        for _ in range(_ROUNDS):
            self.curve = _curve_matrix(U[self.group], self.ticks)
            options = {"maxiter": _STEPS, "maxcor": 15}
            found: Any = minimize(
                self._at, U[self.free].ravel(), jac=True, method="L-BFGS-B", options=options
            )
            U[self.free] = found.x.reshape(-1, 2)
        # of the difference, so that what did not move keeps its bits
        return self.P + (U - self.start)[self.group] * self.plane.radius

    def _at(self, z: FloatArray) -> tuple[float, FloatArray]:
        U = self.start.copy()
        U[self.free] = z.reshape(-1, 2)
        value, gradient = self.loss(U)
        return value, gradient[self.free].ravel()

    def loss(self, U: FloatArray) -> tuple[float, FloatArray]:
        """Return stress plus weighted deviations, and the derivatives by the (u, 2) places `U`."""
        Q = U[self.group]
        stress, by_frame = self._stress(Q)
        T = self.curve @ Q
        deviation, by_middle, by_place = self._deviation(T, U)
        by_frame += self.curve.T @ by_middle
        np.add.at(by_place, self.group, by_frame)
        return stress + deviation, by_place

    def _stress(self, Q: FloatArray) -> tuple[float, FloatArray]:
        sums = np.zeros((2, len(Q)))
        stress = pair_sums(
            self.D, np.ascontiguousarray(Q[:, 0]), np.ascontiguousarray(Q[:, 1]), sums[0], sums[1]
        )
        gradient = 2.0 * (len(Q) * (Q - Q.mean(axis=0)) - sums.T)
        return stress / self.total, gradient / self.total

    def _deviation(self, T: FloatArray, U: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        u, m = len(U), self.values.shape[1]
        among, slope_among = np.zeros((u, u)), np.zeros((u, u))
        between, slope_between = np.zeros((len(T), u)), np.zeros((len(T), u))
        pair_tables(U, U, among, slope_among)
        pair_tables(T, U, between, slope_between)
        A = np.zeros((u + 3, u + 3))
        A[:u, :u], A[:u, u], A[:u, u + 1 :] = among, 1.0, U
        A[u:, :u] = A[:u, u:].T
        factor = lu_factor(A, check_finite=False)
        W = lu_solve(factor, np.concatenate([self.values, np.zeros((3, m))]), check_finite=False)
        off = (between @ W[:u] + W[u] + T @ W[u + 1 :] - self.path) / self.steps
        square = np.square(off).sum(axis=1)
        by_value = (2.0 * _WEIGHT / len(T) / (1.0 + square))[:, None] * off / self.steps
        by_weight = np.concatenate([between.T @ by_value, [by_value.sum(axis=0)], T.T @ by_value])
        by_middle, by_place = by_value @ W[u + 1 :].T, np.zeros((u, 2))
        pull_back(T, U, slope_between, by_value @ W[:u].T, by_middle, by_place)
        # W solves A W = values, so a change of A changes the sum by -L^T dA W
        L = lu_solve(factor, by_weight, check_finite=False)
        pull_back(U, U, slope_among, -L[:u] @ W[:u].T, by_place, by_place)
        by_place -= L[:u] @ W[u + 1 :].T + W[:u] @ L[u + 1 :].T
        return _WEIGHT * float(np.log1p(square).mean()), by_middle, by_place


def _curve_matrix(P: FloatArray, ticks: FloatArray) -> FloatArray:
    """Return the (N, n) matrix that takes places of frames to places of the curve through them."""
    u = centripetal_parameters(P)
    pace = monotone_map(np.arange(len(P), dtype=np.float64), u)
    return interpolating_spline(u, np.eye(len(P)))(pace(ticks))
