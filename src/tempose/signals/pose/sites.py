"""The order in which frames become sites of the pose signal (section 3.2.2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from tempose._validate import as_floats, read_only
from tempose.signals.pose._greedy import GreedyFit, first_four
from tempose.signals.pose.basis import SiteBasis, phi, plane_of
from tempose.signals.pose.merging import Places, merge_places
from tempose.signals.pose.signal import PoseSignal
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class SiteOrder:
    """Frames in the order in which they become sites, and the pose signal for every number of them."""

    order: IntArray
    """(u,) frames; the first l of them are the sites for l."""
    errors: FloatArray
    """(n + 1,) squared residual over all frames for l sites, 0 <= l <= n; it never rises. Below `least` it is
    that about the mean (at 0: about zero), above the number of distinct places the floor."""
    floor: float
    """Squared residual that frames at one place with different poses leave for any l."""
    places: Places
    """Distinct places; their number is the most sites there can be."""
    basis: SiteBasis
    """Columns of the least-squares problem, in the order of the sites."""
    factors: tuple[FloatArray, FloatArray]
    """(u, d) orthonormal rows and a (u, u) upper triangle; on l sites the problem uses the first l."""

    @property
    def least(self) -> int:
        """Fewest sites of a signal: 3; less where all places lie on a line or at one point."""
        return len(self.basis.anchors)

    @property
    def most(self) -> int:
        """Most sites that differ from one another."""
        return len(self.order)

    def signal(self, l: int | None = None) -> PoseSignal:
        """Return the least-squares pose signal on the first l sites.

        Parameters
        ----------
        l : int, optional
            Number of sites, at least `least`; `most` of them if left out or larger.

        Returns
        -------
        PoseSignal
            The spline of least squared error over all frames.

        Raises
        ------
        ValueError
            If l is below `least`.
        """
        count = self.most if l is None else min(l, self.most)
        if count < self.least:
            raise ValueError(f"l must be {self.least} to {len(self.errors) - 1}, got {l}")
        basis = SiteBasis(self.basis.plane, self.basis.anchors, self.basis.others[: count - self.least])
        Q, T = self.factors[0][:count], self.factors[1][:count, :count]
        root = np.sqrt(self.places.weights)[:, None]
        coefficients = solve_triangular(T, Q @ (root * self.places.values))
        # once more on what is left: with hundreds of close sites the first solution loses digits
        rest = self.places.values - basis.columns(basis.plane(self.places.positions)) @ coefficients
        coefficients += solve_triangular(T, Q @ (root * rest))
        return basis.signal(coefficients)


def order_sites(
    P: FloatArray, X: FloatArray, weights: FloatArray | None = None, most: int | None = None
) -> SiteOrder:
    """Choose frames one after another as sites, always the one with the greatest error.

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames in the pose plane, in order of time.
    X : (n, m) float
        Their shape coordinates.
    weights : (n,) float, optional
        How much the squared error of each frame counts, positive; 1 if left out.
    most : int, optional
        Sites at most; as many as there are distinct places if left out.

    Returns
    -------
    SiteOrder
        The order, the error for every number of sites, and the signals.

    Raises
    ------
    ValueError
        If shapes disagree, values are not finite, or weights are not positive.

    Notes
    -----
    A further site appends one column to the least-squares problem: it is made orthogonal to those before,
    and the residuals of all frames lose their part along it. So the whole order, with every error, costs one
    Gram-Schmidt process, where the paper solves a problem for every l. Frames at one place
    (`tempose.signals.pose.merging`) are one site.
    """
    P = as_floats(P, "P", ("n", 2))
    X = as_floats(X, "X", (len(P), "m"))
    if len(P) == 0:
        raise ValueError("P must hold at least one frame")
    if weights is not None and (as_floats(weights, "weights", (len(P),)) <= 0).any():
        raise ValueError(f"weights must be positive, got {np.min(weights):.3g}")
    places = merge_places(P, X, weights)
    plane = plane_of(places.positions)
    q = plane(places.positions)
    first = first_four(plane, q, places.values)
    n_anchors = len(plane.axes) + 1
    basis = SiteBasis(plane, q[first[:n_anchors]], q)
    fit = GreedyFit(np.sqrt(places.weights)[:, None], places.values, len(q))
    for column in plane.affine(q).T:
        fit.append(column)
    most = len(q) if most is None else max(min(most, len(q)), n_anchors)
    order = _choose(fit, basis, q, first, most)
    count = len(order)
    return SiteOrder(
        read_only(places.first[order]),
        read_only(_errors(fit.errors, places, len(P))),
        places.floor,
        places,
        SiteBasis(plane, basis.anchors, q[order[n_anchors:]]),
        (fit.Q[:count], fit.T[:count, :count]),
    )


def _choose(fit: GreedyFit, basis: SiteBasis, q: FloatArray, first: IntArray, most: int) -> IntArray:
    n_anchors = len(basis.anchors)
    candidates = (phi(q, q) - phi(q, basis.anchors) @ basis.shares()).T
    order, taken = list(first[:n_anchors]), np.zeros(len(q), dtype=np.bool_)
    taken[order] = True
    waiting = list(first[n_anchors:])
    while len(order) < most:
        site = waiting.pop(0) if waiting else fit.farthest(taken)
        if site < 0:
            break
        taken[site] = True
        if fit.append(candidates[site]):
            order.append(site)
    return np.array(order, dtype=np.int64)


def _errors(found: list[float], places: Places, n: int) -> FloatArray:
    """Return the errors for 0 to n sites, from those after each column."""
    w = places.weights[:, None]
    mean = (places.values * w).sum(axis=0) / w.sum()
    errors = np.full(n + 1, found[-1])
    errors[: len(found) + 1] = [np.square(places.values * np.sqrt(w)).sum(), *found]
    least = 1 if len(found) < 3 else 3
    errors[1:least] = (np.square(places.values - mean) * w).sum()
    return np.minimum.accumulate(errors) + places.floor
