"""Forward kinematics: local rotations to world rotations and positions."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.rotations import multiply, rotate
from tempose.typing import FloatArray


def forward_kinematics(
    skeleton: Skeleton, rotations: FloatArray, root_position: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """World rotation and position of every joint.

    Parameters
    ----------
    skeleton : Skeleton
        J joints, parents first.
    rotations : (..., J, 4) float
        Local rotations wxyz, the whole rotation from a joint's basis to its parent's.
    root_position : (..., 3) float
        World position of the root, metres.

    Returns
    -------
    world_rotations : (..., J, 4) ndarray
        Rotation of each joint's basis in the world.
    positions : (..., J, 3) ndarray
        Joint positions, metres.
    """
    local = np.asarray(rotations, dtype=np.float64)
    world = np.array(local)
    positions = np.zeros((*local.shape[:-1], 3))
    positions[..., 0, :] = root_position
    for j in range(1, skeleton.n_joints):
        p = int(skeleton.parents[j])
        world[..., j, :] = multiply(world[..., p, :], local[..., j, :])
        positions[..., j, :] = positions[..., p, :] + rotate(world[..., p, :], skeleton.offsets[j])
    return world, positions


def rest_transforms(skeleton: Skeleton) -> tuple[FloatArray, FloatArray]:
    """World rotation and position of every joint in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.

    Returns
    -------
    world_rotations : (J, 4) ndarray
        Rest rotations in the world, wxyz.
    positions : (J, 3) ndarray
        Rest positions, metres.
    """
    assert skeleton.rest_rotations is not None
    return forward_kinematics(skeleton, skeleton.rest_rotations, skeleton.offsets[0])


def rest_motion(skeleton: Skeleton, name: str = "") -> SkeletonClip:
    """Make a motion of one frame in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    name : str, default ""
        Of the motion.

    Returns
    -------
    SkeletonClip
        One frame.
    """
    assert skeleton.rest_rotations is not None
    return SkeletonClip(skeleton, skeleton.rest_rotations[None], skeleton.offsets[:1], name=name)
