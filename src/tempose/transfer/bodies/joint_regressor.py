"""Joints of a deformed mesh, read off its surface."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.transfer.frames import gather
from tempose.typing import FloatArray, IntArray

_SUPPORT = 48


def regress_points(
    V: FloatArray, points: FloatArray, candidates: list[IntArray]
) -> tuple[IntArray, FloatArray]:
    """Weights that give points inside a mesh from vertices near them.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices.
    points : (k, 3) float
        Points, such as joints, at rest.
    candidates : list of (c,) int
        Vertices that each point may use.

    Returns
    -------
    vertices : (k, s) ndarray of int
        Vertices of each point, the nearest of its candidates.
    weights : (k, s) ndarray
        Affine weights of least norm: rows sum to 1 and give the point exactly at rest, and wherever the
        vertices move rigidly.
    """
    vertices = np.zeros((len(points), _SUPPORT), dtype=np.int64)
    weights = np.zeros((len(points), _SUPPORT))
    for i, (point, mine) in enumerate(zip(points, candidates)):
        k = min(_SUPPORT, len(mine))
        near = mine[np.atleast_1d(KDTree(V[mine]).query(point, k=k)[1])]
        A = np.vstack([V[near].T, np.ones(k)])
        base = np.full(k, 1 / k)
        vertices[i, :k] = near
        weights[i, :k] = base + np.linalg.lstsq(A, np.r_[point, 1.0] - A @ base, rcond=1e-10)[0]
    return vertices, weights


def apply_regressor(V: FloatArray, vertices: IntArray, weights: FloatArray) -> FloatArray:
    """Points of every frame.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames.
    vertices : (k, s) int
        From `regress_points`.
    weights : (k, s) float
        From `regress_points`.

    Returns
    -------
    (T, k, 3) ndarray
        Points.
    """
    used = gather(V, vertices.ravel()).reshape(len(V), *vertices.shape, 3)
    return np.einsum("ks,tksi->tki", weights, used)
