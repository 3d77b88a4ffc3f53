"""Where the root of our skeleton goes when another one travels."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rigging.motions.rests import Rests
from tempose.typing import FloatArray

_LOW = 5.0


def root_path(
    skeleton: Skeleton, rotations: FloatArray, places: FloatArray, pairs: dict[int, int], rests: Rests
) -> FloatArray:
    """Path of our root.

    Parameters
    ----------
    skeleton : Skeleton
        Ours, J joints.
    rotations : (T, J, 4) float
        Local rotations of our joints in the motion.
    places : (T, K, 3) float
        Their joints in the world, metres.
    pairs : dict of int to int
        Our joint to theirs; holds our root.
    rests : Rests
        How the skeletons compare.

    Returns
    -------
    (T, 3) ndarray
        Of the same body their path as it stands. Else scaled by the length of the bones, and set to the
        height at which our lowest joint is as low as it is at rest, most of the time that it is low.
    """
    path = rests.scale * places[:, pairs[0]]
    if rests.same:
        return path
    joints = forward_kinematics(skeleton, rotations, path)[1]
    floor = rest_transforms(skeleton)[1][:, 1].min()
    lowest = np.percentile(joints[..., 1].min(axis=1), _LOW)
    return path + np.array([0.0, floor - lowest, 0.0])
