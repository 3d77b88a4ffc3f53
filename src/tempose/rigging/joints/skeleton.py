"""A skeleton of constant bone lengths from free bones."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.rigging.decomposition import Decomposition
from tempose.rigging.joints.pairs import pair_joints
from tempose.rigging.joints.regions import surface_gaps
from tempose.rigging.joints.surface import surface_links
from tempose.rigging.joints.tree import bone_tree
from tempose.rotations import conjugate, multiply, rotate
from tempose.typing import FloatArray, IntArray


def skeleton_from_bones(
    bones: Decomposition, faces: IntArray | None = None, *, fps: float = 30.0
) -> tuple[Skeleton, FloatArray, SkeletonClip]:
    """Join the bones of a decomposition.

    Parameters
    ----------
    bones : Decomposition
        B free bones and their weights.
    faces : (m, 3) int, optional
        The surface; with it bones that are far apart along the surface are not joined, however alike they
        move. It may be in pieces.
    fps : float, default 30.0
        Frames per second of the motion.

    Returns
    -------
    skeleton : Skeleton
        B joints ``bone_00``, ``bone_01`` ..., parents first; the root holds the middle of the body. The rest
        pose is that of the mesh, without rotations.
    weights : (n, B) ndarray
        Weights in the order of the joints.
    motion : SkeletonClip
        T frames: the rotations of the bones, the place of the root. Bones below the root are where the
        joints put them, which is not where they were free to be: fit the poses again.

    Notes
    -----
    The tree spans the pairs whose joint tears least over the frames, among bones that share vertices and are
    near along the surface, in the spirit of [1]_ without its pruning.

    References
    ----------
    .. [1] Le and Deng, "Robust and Accurate Skeletal Rigging from Mesh Sequences", SIGGRAPH 2014.
    """
    skeleton, motion, order = hang_bones(bones, faces, fps)
    return skeleton, bones.weights[:, order], motion


def hang_bones(
    bones: Decomposition, faces: IntArray | None, fps: float
) -> tuple[Skeleton, SkeletonClip, IntArray]:
    """Join bones, and tell which became which joint.

    Parameters
    ----------
    bones, faces, fps
        As for `skeleton_from_bones`.

    Returns
    -------
    skeleton, motion
        As from `skeleton_from_bones`.
    order : (B,) ndarray of int
        Bone of each joint.
    """
    pairs = pair_joints(bones)
    diagonal = float(np.linalg.norm(np.ptp(bones.rest, axis=0)))
    masses = bones.weights.sum(axis=0)
    gaps = None if faces is None else surface_gaps(bones.weights, surface_links(bones.rest, faces))
    order, parents = bone_tree(pairs, masses, diagonal, gaps)
    weights = bones.weights[:, order]
    centres = (weights.T @ bones.rest) / masses[order][:, None]
    joints = np.array([pairs.places[order[p], b] if p >= 0 else centres[0] for b, p in zip(order, parents)])
    above = np.where(parents[:, None] >= 0, joints[np.maximum(parents, 0)], 0.0)
    digits = len(str(len(order) - 1))
    names = tuple(f"bone_{k:0{max(2, digits)}d}" for k in range(len(order)))
    tips = _tips(bones.rest, weights, joints, parents)
    skeleton = Skeleton(names, parents, joints - above, tips=tips)
    turns = bones.rotations[:, order]
    local = multiply(conjugate(turns[:, np.maximum(parents, 0)]), turns)
    local[:, 0] = turns[:, 0]
    root = rotate(turns[:, 0], joints[0]) + bones.translations[:, order[0]]
    return skeleton, SkeletonClip(skeleton, local, root, fps), order


def _tips(rest: FloatArray, weights: FloatArray, joints: FloatArray, parents: IntArray) -> FloatArray:
    """Return ends of leaf bones: from the joint through the middle of what the bone holds to its far side."""
    tips = np.full((len(joints), 3), np.nan)
    for b in np.setdiff1d(np.arange(len(joints)), parents):
        held = weights[:, b] >= 0.5 * weights[:, b].max()
        away = rest[held] - joints[b]
        middle = away.mean(axis=0)
        length = float(np.linalg.norm(middle))
        if length > 0:
            along = away @ middle / length
            tips[b] = middle / length * max(float(np.quantile(along, 0.9)), length)
    return tips
