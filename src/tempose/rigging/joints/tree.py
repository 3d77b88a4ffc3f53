"""Which bones hang on which: the tree that holds together best."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree, shortest_path

from tempose.rigging.joints.pairs import PairJoints
from tempose.typing import FloatArray, IntArray

_FAR = 0.05  # of the diagonal: what bones so far apart share is the blend's doing, not a joint


def bone_tree(
    pairs: PairJoints, masses: FloatArray, diagonal: float, gaps: FloatArray | None = None
) -> tuple[IntArray, IntArray]:
    """Hang the bones on one another.

    Parameters
    ----------
    pairs : PairJoints
        Joints of all pairs of B bones.
    masses : (B,) float
        Sum of the weights of each bone.
    diagonal : float
        Size of the mesh, metres.
    gaps : (B, B) float, optional
        How far what the bones hold is apart along the surface, metres, see `surface_gaps`; by default
        nothing is known of the surface.

    Returns
    -------
    order : (B,) ndarray
        Bones, parents before children.
    parents : (B,) ndarray
        Place in `order` of the parent of ``order[i]``, -1 for the root.
    """
    tree = minimum_spanning_tree(edge_costs(pairs, masses, diagonal, gaps))
    links = ((tree + tree.T) > 0).astype(np.float64)
    root = _root(links.toarray(), masses)
    order, above = breadth_first_order(links, root, directed=False)
    place = np.zeros(len(order), dtype=np.int64)
    place[order] = np.arange(len(order))
    parents = np.array([place[above[b]] if b != root else -1 for b in order], dtype=np.int64)
    return order.astype(np.int64), parents


def edge_costs(
    pairs: PairJoints, masses: FloatArray, diagonal: float, gaps: FloatArray | None = None
) -> FloatArray:
    """How little two bones look like neighbours in a skeleton.

    Parameters
    ----------
    pairs : PairJoints
        Joints of all pairs of B bones.
    masses : (B,) float
        Sum of the weights of each bone.
    diagonal : float
        Size of the mesh, metres.
    gaps : (B, B) float, optional
        How far what the bones hold is apart along the surface, metres, see `surface_gaps`; by default
        nothing is known of the surface.

    Returns
    -------
    (B, B) ndarray
        Positive off the diagonal: how far the joint tears and strays, and the bones are apart along the
        surface, in diagonals, over the part of the smaller bone's vertices that both hold.
    """
    overlap = pairs.shared / np.minimum.outer(masses, masses)
    torn = np.sqrt(pairs.apart**2 + 0.05 * pairs.stray**2) / diagonal
    if gaps is not None:
        torn = torn + gaps / diagonal
        overlap = overlap * np.exp(-gaps / (_FAR * diagonal))
    costs = (torn + 0.005) / (overlap + 0.01)
    np.fill_diagonal(costs, 0.0)
    return np.asarray(0.5 * (costs + costs.T))


def _root(links: FloatArray, masses: FloatArray) -> int:
    """Return the bone from which the others, weighed by what they hold, are the fewest joints away."""
    steps = shortest_path(links, unweighted=True, directed=False)
    far = steps @ masses
    return int(np.argmin(far - 1e-9 * masses))
