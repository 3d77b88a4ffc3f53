"""Holes of a surface, closed by fans so that it encloses a volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Caps:
    """One fan a hole: its apex is the mean of the vertices round the hole, in every frame anew."""

    edges: IntArray
    """(b, 2) directed edges of the fans, against the direction of the surface."""
    times: FloatArray
    """(b,) how often the surface has that edge too many: 1 on an ordinary boundary."""
    hole: IntArray
    """(b,) hole that each edge belongs to."""
    apex: Any
    """(h, n) sparse matrix that takes vertices to the apices."""


def close_holes(F: IntArray, n: int) -> Caps:
    """Find what closes a surface.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    Caps
        Empty for a closed surface.

    Notes
    -----
    The boundary of an oriented surface, counted with signs, is a sum of closed curves whatever the faces:
    a cone over each connected part of it closes non-manifold and inconsistently oriented meshes as well.
    """
    a, b = F.ravel().astype(np.int64), np.roll(F, -1, axis=1).ravel().astype(np.int64)
    low, high = np.minimum(a, b), np.maximum(a, b)
    key, inverse = np.unique(low * n + high, return_inverse=True)
    net = np.bincount(inverse.ravel(), np.where(a < b, 1.0, -1.0), minlength=len(key))
    open_, net = key[net != 0], net[net != 0]
    low, high = open_ // max(n, 1), open_ % max(n, 1)
    # the surface runs low -> high where net > 0, so the fan runs high -> low
    edges = np.where((net > 0)[:, None], np.column_stack([high, low]), np.column_stack([low, high]))
    hole, apex = _holes(low, high, n)
    return Caps(edges, np.abs(net), hole, apex)


def _holes(low: IntArray, high: IntArray, n: int) -> tuple[IntArray, Any]:
    if len(low) == 0:
        return np.zeros(0, dtype=np.int64), sp.csr_array((0, n))
    graph = sp.coo_array((np.ones(len(low)), (low, high)), shape=(n, n)).tocsr()
    labels = connected_components(graph, directed=False)[1]
    rim = np.unique(np.concatenate([low, high]))
    used, of_rim = np.unique(labels[rim], return_inverse=True)
    share = 1.0 / np.bincount(of_rim)
    apex = sp.coo_array((share[of_rim], (of_rim, rim)), shape=(len(used), n)).tocsr()
    return np.searchsorted(used, labels[low]), apex
