"""Rays in the plane of a cross section."""

from __future__ import annotations

import numpy as np

from tempose.transfer.correspondence.limb import Limb
from tempose.typing import BoolArray, FloatArray, IntArray


def shoot_ring(limb: Limb, first: FloatArray, angles: FloatArray) -> tuple[IntArray, FloatArray, BoolArray]:
    """Shoot rays from the centre of a section and find where they leave it.

    Parameters
    ----------
    limb : Limb
        Where.
    first : (3,) float
        Point in the direction of angle 0.
    angles : (k,) float
        Radians, right-handed about the axis.

    Returns
    -------
    faces : (k,) ndarray of int
        Face met by each ray.
    points : (k, 3) ndarray
        Where, metres.
    met : (k,) ndarray of bool
        False where a ray leaves through a hole; then face and point are the nearest by angle.
    """
    x = first - limb.centre
    x = x - (x @ limb.axis) * limb.axis
    x = x / max(float(np.linalg.norm(x)), 1e-300)
    y = np.cross(limb.axis, x)
    P = np.column_stack([(limb.loop.points - limb.centre) @ x, (limb.loop.points - limb.centre) @ y])
    area = np.sum(P[:-1, 0] * P[1:, 1] - P[:-1, 1] * P[1:, 0])
    P = P if area >= 0 else P * [1.0, -1.0]
    rays = np.column_stack([np.cos(angles), np.sin(angles) * (1.0 if area >= 0 else -1.0)])
    segment, share, met = _leave(P, rays)
    A, B = limb.loop.points[segment], limb.loop.points[segment + 1]
    return limb.loop.faces[segment], A + share[:, None] * (B - A), met


def _leave(P: FloatArray, rays: FloatArray) -> tuple[IntArray, FloatArray, BoolArray]:
    """First segment by which each ray from the origin goes out of a counter-clockwise outline."""
    a, d = P[:-1], np.diff(P, axis=0)
    across = rays[:, [0]] * d[:, 1] - rays[:, [1]] * d[:, 0]
    outwards = across > 0
    safe = np.where(outwards, across, 1.0)
    distance = (a[:, 0] * d[:, 1] - a[:, 1] * d[:, 0]) / safe
    share = (a[:, 0] * rays[:, [1]] - a[:, 1] * rays[:, [0]]) / safe
    hits = outwards & (distance >= 0) & (share >= -1e-12) & (share <= 1 + 1e-12)
    distance = np.where(hits, distance, np.inf)
    segment = distance.argmin(axis=1)
    met: BoolArray = np.asarray(hits.any(axis=1))
    # a ray that leaves by a hole: whatever lies nearest in angle
    middle = a + 0.5 * d
    facing = (rays @ middle.T) / np.maximum(np.linalg.norm(middle, axis=1), 1e-300)
    segment = np.where(met, segment, facing.argmax(axis=1))
    share = np.where(met, share[np.arange(len(rays)), segment], 0.5)
    return segment, np.clip(share, 0.0, 1.0), met
