"""At most a few joints a vertex, chosen so that the skin moves as it did with all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import bone_transforms, linear_blend_skinning
from tempose.rigging.decomposition.weights import weights_for
from tempose.rotations import from_rotation_vector, multiply
from tempose.typing import FloatArray

_FRAMES = 48
_BEND = np.radians(40.0)


def few_weights(skin: SkinnedMesh, motion: SkeletonClip, most: int = 4) -> SkinnedMesh:
    """Bind a skin to fewer joints a vertex.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices, J joints.
    motion : SkeletonClip
        Frames in which the vertices shall stay where they are, as far as that goes.
    most : int, default 4
        Most joints a vertex may follow.

    Returns
    -------
    SkinnedMesh
        Vertices that had no more joints than that keep their weights.

    Notes
    -----
    Least squares over frames of the motion and over poses in which one joint after the other bends: without
    these a vertex would be bound to whatever happened to move alike in the clip, and be torn away by the
    first edit.
    """
    many = np.count_nonzero(skin.weights, axis=1) > most
    if not many.any():
        return skin
    V = skin.mesh.vertices
    part = replace(
        skin, mesh=type(skin.mesh)(V[many], np.zeros((0, 3), np.int32)), weights=skin.weights[many]
    )
    poses = _poses(skin, motion)
    frames = linear_blend_skinning(part, poses.rotations, poses.root_position, poses.skeleton)
    turns, shifts = bone_transforms(skin.skeleton, poses.rotations, poses.root_position, poses.skeleton)
    weights = np.array(skin.weights)
    weights[many] = weights_for(frames, V[many], turns, shifts, weights=part.weights, influences=most)
    return replace(skin, weights=weights)


def _poses(skin: SkinnedMesh, motion: SkeletonClip) -> SkeletonClip:
    """Frames of the motion, and bends of single joints about three axes both ways."""
    chosen = np.unique(np.linspace(0, motion.n_frames - 1, _FRAMES).round().astype(int))
    skeleton = skin.skeleton
    J = skeleton.n_joints
    assert skeleton.rest_rotations is not None
    bends = np.concatenate([np.eye(3), -np.eye(3)]) * _BEND
    rotations: FloatArray = np.tile(skeleton.rest_rotations, (J, 6, 1, 1))
    for j in range(1, J):
        rotations[j, :, j] = multiply(rotations[j, :, j], from_rotation_vector(bends))
    bent = rotations[1:].reshape(-1, J, 4)
    root = np.tile(skeleton.offsets[0], (len(bent), 1))
    return SkeletonClip(
        motion.skeleton,
        np.concatenate([motion.rotations[chosen], bent]),
        np.concatenate([motion.root_position[chosen], root]),
        motion.fps,
    )
