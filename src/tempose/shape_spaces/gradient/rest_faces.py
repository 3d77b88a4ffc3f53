"""The undeformed faces, each in a frame of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.typing import FloatArray, IntArray

FLAT = 1e-6
"""A face lower than this share of its longest edge has no shape from which to measure a deformation."""


@dataclass(frozen=True, eq=False)
class RestFaces:
    """Faces whose first edge is the longest, in frames whose first axis runs along that edge."""

    corners: IntArray
    """(3, m) vertices, in the order of rotation of the given faces."""
    frames: FloatArray
    """(3, 3, m): axis, component, face; the third axis is the normal."""
    longest: FloatArray
    """(m,) length of the first edge, metres."""
    apex: FloatArray
    """(2, m) the third corner seen from the first, in the frame, metres."""
    shares: FloatArray
    """(m,) share of each in the area of the mesh; sums to 1, none is 0."""
    area: FloatArray
    """() area of the mesh, square metres."""
    flat: IntArray
    """(k,) faces without a shape: measured against an equilateral one instead."""

    @property
    def inverse(self) -> FloatArray:
        """(3, m) upper triangle of the inverse of the matrix of both edges."""
        x, y = self.apex
        return np.stack([1 / self.longest, -x / (self.longest * y), 1 / y])


def rest_faces(V: FloatArray, F: IntArray) -> RestFaces:
    """Describe the undeformed faces.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, metres.
    F : (m, 3) int
        Faces; some may be degenerate.

    Returns
    -------
    RestFaces
        Shapes, frames and shares of area.

    Raises
    ------
    ValueError
        If no face has an area.
    """
    corners = _longest_edge_first(V, F)
    a, b, c = V[corners]
    along, to_apex = b - a, c - a
    length = np.linalg.norm(along, axis=1)
    normal = np.cross(along, to_apex)
    double_area = np.linalg.norm(normal, axis=1)
    flat = double_area <= FLAT * length**2
    if flat.all():
        raise ValueError(
            f"rest must have a face with an area, got {len(F)} faces without; check the rest mesh"
        )
    typical = np.median(length[~flat])
    length = np.where(flat, np.maximum(length, 1e-3 * typical), length)
    u = _unit(along, np.array([1.0, 0.0, 0.0]))
    # where there is no normal any perpendicular will do
    spare = np.cross(u, np.eye(3)[np.abs(u).argmin(axis=1)])
    n = _unit(np.where(flat[:, None], spare, normal), spare)
    apex = np.stack([np.einsum("mc,mc->m", to_apex, u), double_area / length])
    apex[:, flat] = length[flat] * np.array([[0.5], [0.75**0.5]])
    area = double_area / 2
    weight = np.maximum(area, 1e-6 * area.mean())
    frames = np.stack([u, np.cross(n, u), n]).transpose(0, 2, 1)
    return RestFaces(
        np.ascontiguousarray(corners),
        np.ascontiguousarray(frames),
        length,
        apex,
        weight / weight.sum(),
        area.sum(),
        np.flatnonzero(flat),
    )


def _longest_edge_first(V: FloatArray, F: IntArray) -> IntArray:
    edges = V[np.roll(F, -1, axis=1)] - V[F]
    first = np.einsum("mkc,mkc->mk", edges, edges).argmax(axis=1)
    turn = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(F, turn, axis=1).T.astype(np.int64)


def _unit(x: FloatArray, otherwise: FloatArray) -> FloatArray:
    length = np.linalg.norm(x, axis=1, keepdims=True)
    found = np.where(length > 0, x / np.where(length > 0, length, 1.0), otherwise)
    return found / np.linalg.norm(found, axis=1, keepdims=True)
