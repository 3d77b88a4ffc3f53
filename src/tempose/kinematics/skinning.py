"""Linear blend skinning, all frames in one matrix product."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics.bone_transforms import bone_transforms
from tempose.rotations import to_matrix
from tempose.typing import FloatArray


def linear_blend_skinning(
    skin: SkinnedMesh, rotations: FloatArray, root_position: FloatArray, skeleton: Skeleton | None = None
) -> FloatArray:
    """Pose a skinned mesh.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to J joints in the skeleton's rest pose.
    rotations : (T, J, 4) float
        Local rotations wxyz.
    root_position : (T, 3) float
        World position of the root, metres.
    skeleton : Skeleton, optional
        The same joints with other offsets, if the motion was made for other bone lengths than the bind pose
        has.

    Returns
    -------
    (T, n, 3) ndarray
        Posed vertices, metres; those bound to nothing stay where they are.
    """
    turn, shift = bone_transforms(skin.skeleton, rotations, root_position, skeleton)
    V1 = np.column_stack([skin.mesh.vertices, np.ones(len(skin.mesh.vertices))])
    # (n, J*4) @ (J*4, T*3): each vertex row holds w_j [x y z 1] for every joint
    lifted = (skin.weights[:, :, None] * V1[:, None, :]).reshape(len(V1), -1)
    matrices = np.concatenate([to_matrix(turn), shift[..., None]], axis=-1)
    columns = matrices.transpose(1, 3, 0, 2).reshape(lifted.shape[1], -1)
    posed = (lifted @ columns).reshape(len(V1), len(turn), 3).transpose(1, 0, 2)
    unbound = skin.weights.sum(axis=1) == 0
    posed[:, unbound] = skin.mesh.vertices[unbound]
    return posed


def bake(skin: SkinnedMesh, clip: SkeletonClip) -> FloatArray:
    """Vertices of every frame of a skeleton clip on its own skinned mesh.

    Parameters
    ----------
    skin : SkinnedMesh
        Bound to a skeleton of the same joints as that of `clip`.
    clip : SkeletonClip
        T frames; its own offsets are used.

    Returns
    -------
    (T, n, 3) ndarray
        Posed vertices, metres.

    Raises
    ------
    ValueError
        If the joints differ.
    """
    if clip.skeleton.names != skin.skeleton.names:
        raise ValueError(
            f"clip must move the {skin.skeleton.n_joints} joints of the skin, "
            f"got {clip.skeleton.n_joints} joints, first {clip.skeleton.names[0]!r}"
        )
    return linear_blend_skinning(skin, clip.rotations, clip.root_position, clip.skeleton)
