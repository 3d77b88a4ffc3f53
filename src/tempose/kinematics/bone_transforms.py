"""What a pose does to every bone: the transform from the bind pose to the world."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics.forward import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, multiply, rotate
from tempose.typing import FloatArray


def bone_transforms(
    bind: Skeleton, rotations: FloatArray, root_position: FloatArray, skeleton: Skeleton | None = None
) -> tuple[FloatArray, FloatArray]:
    """Rigid transform of every bone from the bind pose to the posed world.

    Parameters
    ----------
    bind : Skeleton
        J joints in the bind pose.
    rotations : (..., J, 4) float
        Local rotations wxyz.
    root_position : (..., 3) float
        World position of the root, metres.
    skeleton : Skeleton, optional
        The same joints with other offsets, if the motion was made for other bone lengths than the bind pose
        has.

    Returns
    -------
    turns : (..., J, 4) ndarray
        Rotations wxyz: the identity in the bind pose, whatever the rest rotations are.
    shifts : (..., J, 3) ndarray
        Metres: bone j takes a point x of the bind pose to ``rotate(turns[j], x) + shifts[j]``.
    """
    bind_rotations, bind_positions = rest_transforms(bind)
    world, positions = forward_kinematics(skeleton or bind, rotations, root_position)
    turns = multiply(world, conjugate(bind_rotations))
    return turns, positions - rotate(turns, bind_positions)


def local_rotations(bind: Skeleton, turns: FloatArray) -> FloatArray:
    """Local rotations of the joints from the turns of the bones: the way back from `bone_transforms`.

    Parameters
    ----------
    bind : Skeleton
        J joints in the bind pose.
    turns : (..., J, 4) float
        Rotation of each bone from the bind pose to the world, wxyz.

    Returns
    -------
    (..., J, 4) ndarray
        Local rotations wxyz.
    """
    world = multiply(turns, rest_transforms(bind)[0])
    above = world[..., np.maximum(bind.parents, 0), :]
    local = multiply(conjugate(above), world)
    local[..., 0, :] = world[..., 0, :]
    return local
