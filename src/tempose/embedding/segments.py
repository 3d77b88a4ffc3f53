"""Bones as segments: where they run, how far points are from them."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.kinematics.bone_axes import bone_axis
from tempose.kinematics.roles import find_roles
from tempose.typing import FloatArray


def bone_segments(skeleton: Skeleton) -> FloatArray:
    """Segment of the bone that starts at each joint.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.

    Returns
    -------
    (J, 2, 3) ndarray
        From each joint to the next of its chain or to its tip, metres; a joint with neither is a point.
    """
    rotations, positions = rest_transforms(skeleton)
    roles = find_roles(skeleton)
    axes = bone_axis(skeleton, positions, rotations, roles)
    segments = np.stack([positions, positions], axis=1)
    for role, joint in roles.items():
        if role in axes:
            segments[joint, 1] += axes[role]
    return segments


def nearest_on_segments(points: FloatArray, segments: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Nearest point of every segment to every point.

    Parameters
    ----------
    points : (n, 3) float
        Positions.
    segments : (B, 2, 3) float
        Ends of segments.

    Returns
    -------
    nearest : (n, B, 3) ndarray
        Points on the segments.
    distances : (n, B) ndarray
        How far they are.
    """
    start, way = segments[:, 0], segments[:, 1] - segments[:, 0]
    length2 = np.maximum((way**2).sum(axis=1), 1e-300)
    along = (points @ way.T - (start * way).sum(axis=1)) / length2
    nearest = start + np.clip(along, 0.0, 1.0)[..., None] * way
    return nearest, np.linalg.norm(points[:, None] - nearest, axis=2)
