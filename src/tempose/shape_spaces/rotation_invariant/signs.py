"""On which side of its faces a vertex normal lies: the sign that lengths and heights leave open."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.shape_spaces.rotation_invariant.angles import turned
from tempose.shape_spaces.rotation_invariant.branches import search
from tempose.typing import FloatArray, IntArray

_ROUNDS = 6
_AGREED = 1e-11
_EXACT = 1e-9
_ABOVE_NOISE = 30.0
_HOPELESS = 0.01
_NODES = 100_000


@numba.njit(cache=True, nogil=True)
def doubts(views: Any, corners: Any, signs: Any, out: Any) -> None:
    """How far the two ends of each hinge are from seeing one angle.

    Parameters
    ----------
    views, corners : ndarray
        As `views_of_normals` gives them.
    signs : (3 m,) ndarray
        1 or -1 for every corner.
    out : (H,) ndarray
        Filled with the product of what both ends see, less its part that agrees; 0 where they agree.
    """
    for h in range(len(out)):
        a, b = turned(views, h, 0, signs[corners[h, 0, 0]], signs[corners[h, 0, 1]])
        c, d = turned(views, h, 1, signs[corners[h, 1, 0]], signs[corners[h, 1, 1]])
        size = math.sqrt((a * a + b * b) * (c * c + d * d))
        across = a * d - b * c
        along = a * c + b * d
        # size - along without losing its digits
        out[h] = across * across / (size + along) if along > 0 else size - along


class SignSearch:
    """Find the signs with which the two ends of every edge see the same dihedral angle.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    ends : (H, 2) int
        Vertices at the ends of each hinge.

    Notes
    -----
    Signs start as in the reference. Vertices beside an edge whose ends disagree fall into clusters; in each
    a pattern of signs is searched for by branch and bound, first one with no disagreement beyond rounding,
    as the numbers of a mesh have it, then with ten times as much, and so on: under a low bound a wrong
    branch is cut after few signs. Numbers far from any mesh, such as the mean of two poses, disagree
    everywhere; there the signs of the reference stay.
    """

    def __init__(self, F: IntArray, n: int, ends: IntArray) -> None:
        m = len(F)
        self.n, self.ends = n, ends
        self.corners_at = _incidence(F.ravel(), np.arange(3 * m), n, 3 * m)
        self.hinges_at = _incidence(ends.T.ravel(), np.tile(np.arange(len(ends)), 2), n, len(ends))

    def signs(self, corners: IntArray, views: FloatArray, hint: FloatArray) -> tuple[FloatArray, float]:
        """Find the signs.

        Parameters
        ----------
        corners, views : ndarray
            As `views_of_normals` gives them.
        hint : (3 m,) float
            1 or -1 for every corner: where to start, and what to keep between equals.

        Returns
        -------
        signs : (3 m,) ndarray
            1 or -1.
        doubt : float
            Root mean square of the angles by which the ends still disagree, radians; 0 for a mesh.
        """
        signs = hint.copy()
        doubt = np.zeros(len(self.ends))
        doubts(views, corners, signs, doubt)
        for _ in range(_ROUNDS):
            before, limit = doubt.sum(), _stands_out(doubt)
            for own, around in self._clusters(np.flatnonzero(doubt > limit)):
                bound, most = max(_EXACT, 0.1 * limit), doubt[around].sum()
                while bound < most and not search(views, corners, signs, own, around, bound, _NODES):
                    bound *= 10.0
            doubts(views, corners, signs, doubt)
            if not doubt.sum() < 0.999 * before:
                break
        return signs, math.sqrt(2 * float(doubt.mean())) if len(doubt) else 0.0

    def _clusters(self, doubtful: IntArray) -> list[tuple[IntArray, IntArray]]:
        """Corners and hinges of the vertices that hang together by doubtful hinges."""
        if len(doubtful) == 0:
            return []
        ends = self.ends[doubtful]
        graph = sp.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(self.n, self.n))
        vertices = np.unique(ends)
        labels = connected_components(graph.tocsr()[vertices][:, vertices], directed=False)[1]
        clusters: list[tuple[IntArray, IntArray]] = []
        for label in range(labels.max() + 1):
            at = vertices[labels == label]
            own = np.unique(self.corners_at[at].indices).astype(np.int64)
            around = np.unique(self.hinges_at[at].indices).astype(np.int64)
            clusters.append((own, around))
        return clusters


def _stands_out(doubt: FloatArray) -> float:
    """Disagreement above which a sign is likely to be wrong; infinite where the numbers are too noisy."""
    if len(doubt) == 0:
        return math.inf
    most, nearly_all = np.quantile(doubt, [0.6, 0.95])
    if most < 0.1 * _AGREED:
        return _AGREED
    limit = max(_AGREED, _ABOVE_NOISE * float(nearly_all))
    return limit if limit < _HOPELESS else math.inf


def _incidence(rows: IntArray, columns: IntArray, n: int, width: int) -> Any:
    return sp.coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, width)).tocsr()
