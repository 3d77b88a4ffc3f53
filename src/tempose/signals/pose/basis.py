"""The space of thin-plate splines on given sites, as columns: one for every site."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import qr

from tempose.signals.pose.signal import PoseSignal
from tempose.typing import FloatArray, IntArray

FLAT = 1e-6
"""Places whose width is below this part of their length lie on a line."""


@dataclass(frozen=True, eq=False)
class Plane:
    """Coordinates of the pose plane in which the frames have unit size."""

    centre: FloatArray
    """(2,) mean of the places."""
    radius: float
    """Root mean square distance from it."""
    axes: FloatArray
    """(r, 2) orthonormal directions in which the places spread: two, one on a line, none at one point."""

    def __call__(self, p: FloatArray) -> FloatArray:
        """Return places in units of this plane.

        Parameters
        ----------
        p : (N, 2) float
            Places.

        Returns
        -------
        (N, 2) ndarray
            Centred and divided by the radius.
        """
        return (np.asarray(p, dtype=np.float64) - self.centre) / self.radius

    def affine(self, q: FloatArray) -> FloatArray:
        """Return the columns of the affine part.

        Parameters
        ----------
        q : (N, 2) float
            Places in units of this plane.

        Returns
        -------
        (N, r + 1) ndarray
            1 and the coordinates along the axes.
        """
        return np.column_stack([np.ones(len(q)), q @ self.axes.T])


def plane_of(P: FloatArray) -> Plane:
    """Return the unit coordinates of places.

    Parameters
    ----------
    P : (n, 2) float
        Places, n >= 1.

    Returns
    -------
    Plane
        Centre, size and the directions in which they spread.
    """
    centre = P.mean(axis=0)
    radius = float(np.sqrt(np.square(P - centre).sum(axis=1).mean()))
    if radius <= 1e-14 * max(float(np.abs(P).max()), 1e-300):
        return Plane(centre, 1.0, np.zeros((0, 2)))
    _, spread, axes = np.linalg.svd((P - centre) / radius, full_matrices=False)
    rank = int((spread > FLAT * spread[0]).sum())
    # on the plane itself the given axes will do, and keep values exactly as the paper writes them
    return Plane(centre, radius, np.eye(2) if rank == 2 else axes[:rank])


def best_anchors(plane: Plane, q: FloatArray) -> IntArray:
    """Choose the sites that carry the side conditions.

    Parameters
    ----------
    plane : Plane
        Its axes say how many are needed: one more than there are directions.
    q : (k, 2) float
        Candidates, in units of the plane.

    Returns
    -------
    (r + 1,) ndarray of int
        Candidates with well conditioned affine coordinates, ascending; fewer if they are all on a line.
    """
    columns = plane.affine(q).T
    found: Any = qr(columns, mode="economic", pivoting=True)
    sizes, pivots = np.abs(np.diagonal(found[1])), found[2]
    rank = int((sizes > FLAT * sizes[0]).sum())
    return np.sort(pivots[:rank]).astype(np.int64)


def phi(q: FloatArray, s: FloatArray) -> FloatArray:
    """Return ``r^2 log r`` between places and sites.

    Parameters
    ----------
    q : (N, 2) float
        Places.
    s : (l, 2) float
        Sites.

    Returns
    -------
    (N, l) ndarray
        0 where they coincide.
    """
    r2 = np.square(q[:, None, 0] - s[None, :, 0]) + np.square(q[:, None, 1] - s[None, :, 1])
    return 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))


@dataclass(frozen=True, eq=False)
class SiteBasis:
    """Columns ``1, q`` and, of every further site, ``phi_j`` less its share in those of the anchors.

    With the shares ``lambda(s_j)``, the affine coordinates of the site in the anchors, every combination of
    these columns fulfils the side conditions of the spline, and every spline on these sites is one.
    """

    plane: Plane
    anchors: FloatArray
    """(r + 1, 2) anchor sites, in units of the plane."""
    others: FloatArray
    """(l - r - 1, 2) the further sites."""

    def columns(self, q: FloatArray) -> FloatArray:
        """Return the columns at places.

        Parameters
        ----------
        q : (N, 2) float
            Places in units of the plane.

        Returns
        -------
        (N, l) ndarray
            Affine columns, then one for every further site.
        """
        rest = phi(q, self.others) - phi(q, self.anchors) @ self.shares()
        return np.column_stack([self.plane.affine(q), rest])

    def shares(self) -> FloatArray:
        """Return the affine coordinates of the further sites in the anchors.

        Returns
        -------
        (r + 1, l - r - 1) ndarray
            Columns sum to 1.
        """
        return np.linalg.solve(self.plane.affine(self.anchors).T, self.plane.affine(self.others).T)

    def signal(self, coefficients: FloatArray) -> PoseSignal:
        """Return the spline with given coefficients, in the paper's form.

        Parameters
        ----------
        coefficients : (l, m) float
            Of the columns.

        Returns
        -------
        PoseSignal
            Its sites are the anchors, then the further sites.
        """
        plane, r = self.plane, len(self.plane.axes)
        linear, own = coefficients[: r + 1], coefficients[r + 1 :]
        affine = np.concatenate([linear[:1], plane.axes.T @ linear[1:]])
        weights = np.concatenate([-self.shares() @ own, own])
        sites = np.concatenate([self.anchors, self.others]) * plane.radius + plane.centre
        return PoseSignal(sites, weights, affine, plane.centre, plane.radius)
