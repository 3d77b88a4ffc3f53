"""Left and right of one mesh: its plane of symmetry and the place opposite to each place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from tempose.clips import Mesh
from tempose.geometry import face_normals
from tempose.transfer.correspondence.closest import Cloud, make_cloud
from tempose.transfer.correspondence.side_names import swap_side
from tempose.transfer.correspondence.topology import mirrored_faces
from tempose.typing import BoolArray, FloatArray, IntArray

_ROUNDS, _TRIM = 30, 0.8
_ACROSS = 0.8
"""+X is taken for across unless another plane fits so much better."""
_BEND = 0.03


@dataclass(frozen=True)
class Symmetry:
    """What lies opposite to what."""

    point: FloatArray
    """(3,) on the plane, metres."""
    normal: FloatArray
    """(3,) unit normal of the plane."""
    faces: IntArray
    """(m,) int, the face opposite to each face."""
    errors: FloatArray
    """(m,) distance from the reflected middle of a face to that of its opposite, share of the diagonal; in a
    pose that is not symmetric it is large even where the opposite is known for sure."""
    sure: BoolArray
    """(m,) bool, opposites found by connectivity, which no pose can spoil."""
    residual: float
    """Trimmed rms of the distances from the reflected surface to the surface, share of the diagonal."""

    def reflect(self, points: FloatArray) -> FloatArray:
        """Reflect points in the plane.

        Parameters
        ----------
        points : (..., 3) float
            Metres.

        Returns
        -------
        (..., 3) ndarray
            Metres.
        """
        return points - 2 * ((points - self.point) @ self.normal)[..., None] * self.normal


def find_symmetry(mesh: Mesh) -> Symmetry:
    """Find left and right of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Symmetric, or roughly, or symmetric but for its pose.

    Returns
    -------
    Symmetry
        Plane and opposites: by connectivity where that is symmetric, else the nearest face to the
        reflected one whose normal agrees, within the group of the other side where groups are so named.

    Raises
    ------
    ValueError
        If the mesh has no extent.
    """
    if len(mesh.faces) < 4 or mesh.diagonal == 0:
        raise ValueError(f"mesh must be a surface of at least 4 triangles, got {len(mesh.faces)}")
    cloud = make_cloud(mesh.vertices, mesh.faces)
    point, normal, residual = _plane(cloud)
    V, F = mesh.vertices, mesh.faces
    V_other = V - 2 * ((V - point) @ normal)[:, None] * normal
    P, N = V[F].mean(axis=1), face_normals(V, F)
    P_other, N_other = V_other[F].mean(axis=1), N - 2 * (N @ normal)[:, None] * normal
    opposite = _nearest(P, N, P_other, N_other, mesh.diagonal, mesh.groups)
    known = mirrored_faces(V, F, V_other, opposite)
    sure = known >= 0
    opposite = np.where(sure, known, opposite)
    errors = np.linalg.norm(P[opposite] - P_other, axis=1) / mesh.diagonal
    return Symmetry(point, normal, opposite, errors, sure, residual)


def _plane(cloud: Cloud) -> tuple[FloatArray, FloatArray, float]:
    starts = [np.array([1.0, 0.0, 0.0]), *cloud.axes.T, np.array([0.0, 0.0, 1.0])]
    best, best_cost = None, np.inf
    for i, start in enumerate(starts):
        plane = _refine_plane(cloud, start)
        # up is never across: front and back, top and bottom of a doll may fit just as well
        cost = plane[2] * (1.0 if i == 0 else 1 / _ACROSS) + 1e-9 * i
        if cost < best_cost:
            best, best_cost = plane, cost
    assert best is not None
    return best


def _refine_plane(cloud: Cloud, normal: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Fit a plane by iterated closest points between the surface and its reflection."""
    P, point = cloud.points[cloud.probes], cloud.centre
    residual = np.inf
    for _ in range(_ROUNDS):
        mirrored = P - 2 * ((P - point) @ normal)[:, None] * normal
        gap, near = cloud.tree.query(mirrored)
        kept = gap <= np.quantile(gap, _TRIM)
        residual = float(np.sqrt((gap[kept] ** 2).mean())) / cloud.diagonal
        a, b = P[kept], cloud.points[near[kept]]
        middle = 0.5 * (a + b).mean(axis=0)
        A = (a - a.mean(axis=0)).T @ (b - b.mean(axis=0))
        # |a' - (b' reflected)|^2 is least for the direction in which a' and b' agree least
        turned = np.linalg.eigh(A + A.T)[1][:, 0]
        turned = turned if turned @ normal >= 0 else -turned
        step = float(np.abs(turned - normal).max() + abs((middle - point) @ turned) / cloud.diagonal)
        point, normal = middle, turned
        if step < 1e-10:
            break
    return point, normal, residual


def _nearest(
    P: FloatArray,
    N: FloatArray,
    P_other: FloatArray,
    N_other: FloatArray,
    size: float,
    groups: Mapping[str, IntArray],
) -> IntArray:
    def match(mine: IntArray, theirs: IntArray) -> IntArray:
        tree = KDTree(np.hstack([P[theirs], _BEND * size * N[theirs]]))
        return theirs[tree.query(np.hstack([P_other[mine], _BEND * size * N_other[mine]]))[1]]

    every = np.arange(len(P))
    opposite = match(every, every)
    for name, faces in groups.items():
        other = swap_side(name)
        if other != name and other in groups and len(faces) and len(groups[other]):
            opposite[faces] = match(np.asarray(faces), np.asarray(groups[other]))
    return opposite
