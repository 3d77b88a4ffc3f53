"""The direction of a cylindrical part, from its surface round one face."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.geometry import face_areas, face_normals
from tempose.transfer.correspondence.section import Loop, Sections, loop_centre
from tempose.typing import FloatArray, IntArray

_REACH = 0.5
"""How far beside the pick the part is cut again, in thicknesses."""
_ROUNDS = 8
_BULGE = 1.8
"""A neighbouring section so many times longer belongs to the trunk."""
_DIRECTIONS = 8
_SHORTER = 0.95
_FIRM = np.cos(np.radians(50.0))


def limb_axis(sections: Sections, face: int) -> FloatArray:
    """Find the axis of the part round a face.

    Parameters
    ----------
    sections : Sections
        The mesh.
    face : int
        Face on the part.

    Returns
    -------
    (3,) ndarray
        Unit vector, either way along the part.
    """
    point = sections.V[sections.F[face]].mean(axis=0)
    size = thickness(sections.V, sections.F, face)
    first = _axis_of_normals(sections, face, size)
    N = face_normals(sections.V, sections.F[face : face + 1])[0]
    side = np.cross(N, first)
    if np.linalg.norm(side) == 0:
        return first
    side = side / np.linalg.norm(side)
    along = np.cross(side, N)
    angles = np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS
    tangents = [np.cos(a) * along + np.sin(a) * side for a in angles]
    lengths = [_length(sections, face, point, axis) for axis in tangents]
    other = tangents[int(np.argmin(lengths))]
    axes = [_through_centres(sections, face, point, axis, size) for axis in (first, other)]
    lengths = [_length(sections, face, point, axis) for axis in axes]
    return axes[1] if lengths[1] < _SHORTER * lengths[0] else axes[0]


def _length(sections: Sections, face: int, point: FloatArray, axis: FloatArray) -> float:
    loops = sections.cut(point, axis, face)
    return loops[0].length if loops and loops[0].closed else np.inf


def thickness(V: FloatArray, F: IntArray, face: int) -> float:
    """Distance from a face through the body to the surface opposite.

    Parameters
    ----------
    V : (n, 3) float
        Vertices.
    F : (m, 3) int
        Faces.
    face : int
        Where to start.

    Returns
    -------
    float
        Metres; a twentieth of the diagonal where nothing lies opposite.
    """
    fallback = 0.05 * float(np.linalg.norm(np.ptp(V, axis=0)))
    direction = -face_normals(V, F[face : face + 1])[0]
    origin = V[F[face]].mean(axis=0)
    a, b, c = (V[F[:, k]] - origin for k in range(3))
    # signs of three volumes tell whether the ray passes through a triangle
    u, v, w = (np.cross(p, q) @ direction for p, q in ((b, c), (c, a), (a, b)))
    total = u + v + w
    hit = (total != 0) & ((np.minimum(np.minimum(u, v), w) >= 0) | (np.maximum(np.maximum(u, v), w) <= 0))
    hit[face] = False
    if not hit.any():
        return fallback
    depth = ((u[:, None] * a + v[:, None] * b + w[:, None] * c)[hit] @ direction) / total[hit]
    depth = depth[depth > 1e-4 * fallback]
    return float(depth.min()) if len(depth) else fallback


def _axis_of_normals(sections: Sections, face: int, size: float) -> FloatArray:
    V, F = sections.V, sections.F
    N = face_normals(V, F[face : face + 1])[0]
    middle = V[F[face]].mean(axis=0) - 0.5 * size * N
    centres = V[F].mean(axis=1)
    near = np.flatnonzero(((centres - middle) ** 2).sum(axis=1) < size**2)
    near = np.union1d(near, [face])
    near = near[_connected(F[near], len(V), int(np.searchsorted(near, face)))]
    normals, areas = face_normals(V, F[near]), face_areas(V, F[near])
    about = normals - (areas @ normals) / max(float(areas.sum()), 1e-300)
    directions = np.linalg.eigh((areas[:, None] * about).T @ about)[1].T
    # on a nearly flat patch nothing varies along the normal either: a direction within the surface then
    return next(d for d in directions if abs(d @ N) <= _FIRM)


def _connected(F: IntArray, n: int, start: int) -> IntArray:
    k = len(F)
    joins = sp.coo_array((np.ones(3 * k), (np.repeat(np.arange(k), 3), F.ravel())), shape=(k, n)).tocsr()
    labels = connected_components(joins @ joins.T, directed=False)[1]
    return np.flatnonzero(labels == labels[start])


def _through_centres(
    sections: Sections, face: int, point: FloatArray, axis: FloatArray, size: float
) -> FloatArray:
    first = axis
    for _ in range(_ROUNDS):
        here = sections.cut(point, axis, face)
        if not here:
            return axis
        centre = loop_centre(here[0], axis)
        ends = [_beside(sections, here[0], centre, axis, sign * _REACH * size, size) for sign in (1.0, -1.0)]
        ahead, behind = (centre if end is None else end for end in ends)
        span = ahead - behind
        length = float(np.linalg.norm(span))
        if length < 0.2 * _REACH * size or abs(span @ first) < _FIRM * length:
            return axis
        turned, axis = axis, span / length
        if np.linalg.norm(turned - axis) < 1e-13:
            break
    return axis


def _beside(
    sections: Sections, here: Loop, centre: FloatArray, axis: FloatArray, step: float, size: float
) -> FloatArray | None:
    """Centre of the same part's section one step further, None where it ends or widens into the trunk."""
    at = centre + step * axis
    loops = [loop for loop in sections.cut(at, axis) if loop.closed and loop.length < _BULGE * here.length]
    if not loops:
        return None
    centres = np.array([loop_centre(loop, axis) for loop in loops])
    gap = np.linalg.norm(centres - at, axis=1)
    return centres[gap.argmin()] if gap.min() < size else None
