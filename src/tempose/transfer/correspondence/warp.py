"""A smooth warp of space that carries the source onto the target through the pairs known so far."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.geometry import vertex_normals
from tempose.transfer.correspondence.closest import spread_points
from tempose.typing import FloatArray, IntArray

_HELPERS, _ROUNDS = 200, 3
_ENOUGH = 6
_SOFT = 0.1
"""Smoothing of the helpers, whose partners are guessed; pairs are met exactly."""
_BEND = 0.05
"""Normals that disagree count like so much of the diagonal."""


class Warp:
    """``x -> aligned x + displacement``, the displacement a thin-plate spline of space.

    Parameters
    ----------
    points, partners : (k, 3) float
        Aligned points of the source and where they go, metres; any number, also none.
    V, V_target : (n, 3), (p, 3) float
        Aligned source and target vertices.
    F, F_target : (m, 3), (q, 3) int
        Their faces.

    Notes
    -----
    The kernel is ``-|x - y|``, which bends least in space, with a linear part. Beside the pairs some 200
    points spread over the source are drawn, softly, to the nearest place of the target whose normal
    agrees, three times over.
    """

    def __init__(
        self,
        points: FloatArray,
        partners: FloatArray,
        V: FloatArray,
        F: IntArray,
        V_target: FloatArray,
        F_target: IntArray,
    ) -> None:
        size = float(np.linalg.norm(np.ptp(V_target, axis=0)))
        points, partners = _apart(points, partners, 1e-6 * size)
        used = np.unique(F)
        helpers = used[spread_points(V[used], _HELPERS, V[used].mean(axis=0))]
        if len(points):
            gap = KDTree(points).query(V[helpers])[0]
            helpers = helpers[gap > 1e-3 * size]
        tree = KDTree(np.hstack([V_target, _BEND * size * vertex_normals(V_target, F_target)]))
        W = V
        if len(points) >= _ENOUGH:
            # so many pairs tell more of where the parts are than the alignment does; a linear part would run
            # away beyond them
            self._centres = points
            self._fit(partners - points, np.full(len(points), _SOFT * size), linear=False)
            W = self.apply(V)
        for _ in range(_ROUNDS):
            N = vertex_normals(W, F)[helpers]
            _, near = tree.query(np.hstack([W[helpers], _BEND * size * N]))
            self._centres = np.concatenate([points, V[helpers]])
            soft = np.r_[np.zeros(len(points)), np.full(len(helpers), _SOFT * size)]
            self._fit(np.concatenate([partners, V_target[near]]) - self._centres, soft)
            W = self.apply(V)

    def _fit(self, displacement: FloatArray, soft: FloatArray, linear: bool = True) -> None:
        X = self._centres
        self._middle, self._size = X.mean(axis=0), max(float(np.abs(X - X.mean(axis=0)).max()), 1e-300)
        self._columns = 4 if linear else 1
        A, L = _distances(X, X) - np.diag(soft), self._linear(X)
        system = np.block([[A, L], [L.T, np.zeros((self._columns, self._columns))]])
        right = np.vstack([displacement, np.zeros((self._columns, 3))])
        # a flat source leaves the linear part undetermined across it: the least solution then
        self._coefficients = np.linalg.lstsq(system, right, rcond=1e-12)[0]

    def _linear(self, x: FloatArray) -> FloatArray:
        return np.column_stack([np.ones(len(x)), (x - self._middle) / self._size])[:, : self._columns]

    def apply(self, points: FloatArray) -> FloatArray:
        """Carry points over.

        Parameters
        ----------
        points : (p, 3) float
            Aligned points of the source.

        Returns
        -------
        (p, 3) ndarray
            Their places at the target.
        """
        out = np.zeros((len(points), 3))
        for start in range(0, len(points), 4096):
            x = points[start : start + 4096]
            basis = np.hstack([_distances(x, self._centres), self._linear(x)])
            out[start : start + 4096] = x + basis @ self._coefficients
        return out


def _distances(X: FloatArray, Y: FloatArray) -> FloatArray:
    squared = (X**2).sum(axis=1)[:, None] + (Y**2).sum(axis=1) - 2 * X @ Y.T
    return np.sqrt(np.maximum(squared, 0.0))


def _apart(points: FloatArray, partners: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """Merge points that coincide, such as one source face with several partners."""
    if len(points) == 0:
        return np.zeros((0, 3)), np.zeros((0, 3))
    key = np.round(points / max(least, 1e-300)).astype(np.int64)
    _, group = np.unique(key, axis=0, return_inverse=True)
    group = group.ravel()
    count = np.bincount(group)[:, None]
    mean = [
        np.column_stack([np.bincount(group, P[:, k]) for k in range(3)]) / count for P in (points, partners)
    ]
    return mean[0], mean[1]
