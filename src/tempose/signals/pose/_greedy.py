"""The greedy choice of sites as one Gram-Schmidt process."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from tempose.signals.pose.basis import Plane, best_anchors
from tempose.typing import BoolArray, FloatArray, IntArray

DEPENDENT = 1e-9
"""A column of which less than this part is new makes no further site."""


class GreedyFit:
    """Least squares whose columns come one at a time; the residual of every row is always at hand.

    Parameters
    ----------
    root : (u, 1) float
        Square roots of the weights of the rows.
    X : (u, m) float
        Values to fit.
    most : int
        Columns at most.
    """

    def __init__(self, root: FloatArray, X: FloatArray, most: int) -> None:
        self.root = root
        self._weights = np.square(root[:, 0])
        self.rest = root * X
        """(u, m) weighted residual."""
        self.sizes = np.square(self.rest).sum(axis=1)
        """(u,) squared length of its rows."""
        self.Q = np.zeros((most, len(X)))
        """(l, u) orthonormal rows, and..."""
        self.T = np.zeros((most, most))
        """...the (l, l) upper triangle that makes the columns from them."""
        self.count = 0
        self.errors: list[float] = []
        """Squared residual after every column."""

    def append(self, column: FloatArray) -> bool:
        """Take a column in, unless those before it already make it.

        Parameters
        ----------
        column : (u,) float
            The new column, without weights.

        Returns
        -------
        bool
            Whether it was taken.
        """
        k, Q = self.count, self.Q[: self.count]
        v = self.root[:, 0] * column
        size = float(np.linalg.norm(v))
        # twice is enough for orthogonality to rounding
        for _ in range(2):
            parts = Q @ v
            v -= parts @ Q
            self.T[:k, k] += parts
        length = float(np.linalg.norm(v))
        if length <= DEPENDENT * size:
            self.T[:k, k] = 0.0
            return False
        self.T[k, k] = length
        self.Q[k] = v / length
        remove(self.rest, self.Q[k], self.Q[k] @ self.rest, self.sizes)
        self.count += 1
        self.errors.append(float(self.sizes.sum()))
        return True

    def farthest(self, taken: BoolArray) -> int:
        """Return the row with the greatest error among those not taken.

        Parameters
        ----------
        taken : (u,) bool
            Rows to leave out.

        Returns
        -------
        int
            Its index; -1 when all are taken.
        """
        if taken.all():
            return -1
        return int(np.where(taken, -1.0, self.sizes / self._weights).argmax())


@numba.njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def remove(rest: Any, q: Any, part: Any, sizes: Any) -> None:
    """Subtract ``q part^T`` from a matrix and measure its rows, in one pass.

    Parameters
    ----------
    rest : (u, m) float64
        Changed.
    q : (u,) float64
        One factor.
    part : (m,) float64
        The other.
    sizes : (u,) float64
        Written: squared length of the rows.
    """
    for i in range(rest.shape[0]):
        size = 0.0
        for c in range(rest.shape[1]):
            value = rest[i, c] - q[i] * part[c]
            rest[i, c] = value
            size += value * value
        sizes[i] = size


def first_four(plane: Plane, q: FloatArray, X: FloatArray) -> IntArray:
    """Return the frames farthest from the best-fit plane of all poses: step 2 of the greedy algorithm.

    Parameters
    ----------
    plane : Plane
        Unit coordinates of the pose plane.
    q : (u, 2) float
        Distinct places, in units of the plane.
    X : (u, m) float
        Shape coordinates there.

    Returns
    -------
    (k,) ndarray of int
        Four, fewer if there are fewer; the anchors of the spline first. Where the four lie on a line of the
        pose plane, the next farthest frame beside it takes the place of the last.
    """
    distance = _off_plane(X)
    if distance.max() <= 1e-18 * np.square(X - X.mean(axis=0)).sum(axis=1).max():
        # all poses lie in a plane: what is left is rounding, so take frames at the rim
        distance = np.square(q).sum(axis=1)
    ranked = np.argsort(-distance, kind="stable")
    chosen = list(ranked[:4])
    wanted = len(plane.axes) + 1
    for other in ranked[4:]:
        if len(best_anchors(plane, q[chosen])) == wanted:
            break
        if len(best_anchors(plane, q[[*chosen[:-1], other]])) > len(best_anchors(plane, q[chosen[:-1]])):
            chosen[-1] = other
    anchors = best_anchors(plane, q[chosen])
    rest = [c for i, c in enumerate(chosen) if i not in set(anchors.tolist())]
    return np.array([*(chosen[i] for i in anchors), *rest], dtype=np.int64)


def _off_plane(X: FloatArray) -> FloatArray:
    """Squared distance of every point to the best-fit plane."""
    Y = X - X.mean(axis=0)
    if Y.shape[1] <= 2:
        return np.zeros(len(Y))
    covariance = Y.T @ Y
    spread = np.diagonal(covariance)
    if np.abs(covariance - np.diag(spread)).max() > 1e-9 * spread.max():
        Y = Y @ np.linalg.eigh(covariance)[1]
        spread = np.square(Y).sum(axis=0)
    return np.square(Y[:, np.argsort(-spread, kind="stable")[2:]]).sum(axis=1)
