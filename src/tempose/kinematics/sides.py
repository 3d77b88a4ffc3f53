"""Left and right of a body, checked against where its feet point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics.bone_axes import bone_axis
from tempose.typing import FloatArray


def side_contradictions(
    skeleton: Skeleton, world_positions: FloatArray, world_rotations: FloatArray, roles: Mapping[str, int]
) -> tuple[str, ...]:
    """Check by geometry that left is left: +X of a body that stands on +Y and faces +Z.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    world_positions : (..., J, 3) float
        Joint positions, metres, Y up, in one or many poses of a body on its feet.
    world_rotations : (..., J, 4) float
        Rotations of the joints' bases in the world, wxyz.
    roles : mapping of str to int
        From `find_roles`.

    Returns
    -------
    tuple of str
        A sentence for each pair of limbs that lies on the wrong side of where the feet point; empty where
        all agrees or nothing can be said.
    """
    axes = bone_axis(skeleton, world_positions, world_rotations, roles)
    feet = [axes[role] for role in ("left_foot", "right_foot") if role in axes]
    if not feet:
        return ()
    front = np.sum(feet, axis=0)
    left = np.stack([front[..., 2], -front[..., 0]], axis=-1)
    sentences: list[str] = []
    for part in ("thigh", "upper_arm"):
        here, there = roles.get(f"left_{part}"), roles.get(f"right_{part}")
        if here is None or there is None:
            continue
        across = world_positions[..., here, :] - world_positions[..., there, :]
        if np.median(np.sum(across[..., [0, 2]] * left, axis=-1)) < 0:
            name = part.replace("_", " ")
            sentences.append(f"The left {name} lies right of where the feet point: mirrored names or axes.")
    return tuple(sentences)
