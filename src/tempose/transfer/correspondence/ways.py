"""Distances along a surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from tempose.geometry import edge_list, weld
from tempose.typing import FloatArray, IntArray

_KEPT = 256


class Ways:
    """Distances along the edges of a mesh, texture seams closed; kept once they are known.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Faces.
    """

    def __init__(self, V: FloatArray, F: IntArray) -> None:
        first, self._inverse = weld(V)
        self._V = V[first]
        edges = edge_list(self._inverse[F])
        lengths = np.linalg.norm(self._V[edges[:, 0]] - self._V[edges[:, 1]], axis=1)
        k = len(first)
        self._graph: Any = sp.coo_array((lengths, (edges[:, 0], edges[:, 1])), shape=(k, k)).tocsr()
        self._kept: dict[int, FloatArray] = {}

    def place(self, vertices: IntArray) -> IntArray:
        """Return the places of vertices: those at equal positions share one.

        Parameters
        ----------
        vertices : (k,) int
            Vertices.

        Returns
        -------
        (k,) ndarray of int
            Places.
        """
        return self._inverse[vertices]

    def nearest(self, points: FloatArray) -> IntArray:
        """Return the places nearest to points.

        Parameters
        ----------
        points : (k, 3) float
            Metres.

        Returns
        -------
        (k,) ndarray of int
            Places.
        """
        if len(points) == 0:
            return np.zeros(0, dtype=np.int64)
        return np.asarray(KDTree(self._V).query(points)[1], dtype=np.int64)

    def from_place(self, place: int) -> FloatArray:
        """Measure the way from a place to all others.

        Parameters
        ----------
        place : int
            Where to start.

        Returns
        -------
        (p,) ndarray
            Metres, infinite where no way leads.
        """
        if place not in self._kept:
            if len(self._kept) > _KEPT:
                self._kept.clear()
            self._kept[place] = dijkstra(self._graph, directed=False, indices=place)
        return self._kept[place]
