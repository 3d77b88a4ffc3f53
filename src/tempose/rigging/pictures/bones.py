"""Bones as lines that can be drawn over frames."""

from __future__ import annotations

import numpy as np

from tempose.clips import SkeletonClip
from tempose.kinematics import forward_kinematics
from tempose.rotations import rotate
from tempose.typing import FloatArray


def bone_lines(motion: SkeletonClip) -> FloatArray:
    """Lines from every joint to its parent, and from the last joints to their tips.

    Parameters
    ----------
    motion : SkeletonClip
        T frames of J joints.

    Returns
    -------
    (T, J - 1 + tips, 2, 3) ndarray
        Metres.
    """
    skeleton = motion.skeleton
    turns, places = forward_kinematics(skeleton, motion.rotations, motion.root_position)
    below = np.arange(1, skeleton.n_joints)
    lines = np.stack([places[:, skeleton.parents[below]], places[:, below]], axis=2)
    assert skeleton.tips is not None
    known = np.flatnonzero(np.isfinite(skeleton.tips).all(axis=1))
    if len(known) == 0:
        return lines
    ends = places[:, known] + rotate(turns[:, known], skeleton.tips[known])
    return np.concatenate([lines, np.stack([places[:, known], ends], axis=2)], axis=1)
