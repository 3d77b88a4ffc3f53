"""A rig in the digits that its file keeps, so that a model plays the same before and after it is saved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.rigging import Rig
from tempose.rotations import normalise
from tempose.typing import FloatArray

_PARTS = 4096
"""Weights are multiples of one over this."""
INFLUENCES = 8
"""Joints that may move a vertex."""


def lean_rig(rig: Rig) -> Rig:
    """Round a rig: positions and rotations to float32, weights to 1/4096 of at most eight joints.

    Parameters
    ----------
    rig : Rig
        Skin and motion.

    Returns
    -------
    Rig
        Off by about 1e-4 of how far the joints of a vertex move it apart.
    """
    skin = rig.skin
    mesh = skin.mesh.with_vertices(_short(skin.mesh.vertices))
    skeleton = _lean_skeleton(skin.skeleton)
    lean = SkinnedMesh(mesh, skeleton, lean_weights(skin.weights))
    return Rig(lean, lean_motion(rig.motion), rig.blending, dict(rig.report))


def lean_motion(motion: SkeletonClip) -> SkeletonClip:
    """Round a motion to float32.

    Parameters
    ----------
    motion : SkeletonClip
        T frames.

    Returns
    -------
    SkeletonClip
        The same to 1e-7.
    """
    return replace(
        motion,
        skeleton=_lean_skeleton(motion.skeleton),
        rotations=_short(normalise(motion.rotations)),
        root_position=_short(motion.root_position),
    )


def lean_weights(weights: FloatArray, influences: int = INFLUENCES) -> FloatArray:
    """Round weights so that every row still sums to 1 exactly.

    Parameters
    ----------
    weights : (n, J) float
        Skin weights.
    influences : int, default 8
        The smaller weights of a row are left out.

    Returns
    -------
    (n, J) ndarray
        Multiples of 1/4096; rows of zeros stay.
    """
    kept = np.array(weights, dtype=np.float64)
    if kept.shape[1] > influences:
        small = np.argpartition(-kept, influences, axis=1)[:, influences:]
        np.put_along_axis(kept, small, 0.0, axis=1)
    total = kept.sum(axis=1, keepdims=True)
    parts = np.divide(kept, total, out=np.zeros_like(kept), where=total > 0) * _PARTS
    whole = np.floor(parts)
    # what rounding down has lost goes to the largest remainders
    lost = np.rint(parts.sum(axis=1) - whole.sum(axis=1)).astype(np.int64)
    order = np.argsort(whole - parts, axis=1, kind="stable")
    rank = np.argsort(order, axis=1, kind="stable")
    return (whole + (rank < lost[:, None])) / _PARTS


def _lean_skeleton(skeleton: Skeleton) -> Skeleton:
    assert skeleton.rest_rotations is not None and skeleton.tips is not None
    return replace(
        skeleton,
        offsets=_short(skeleton.offsets),
        rest_rotations=_short(normalise(skeleton.rest_rotations)),
        tips=_short(skeleton.tips),
    )


def _short(values: FloatArray) -> FloatArray:
    return np.asarray(values, dtype=np.float32).astype(np.float64)
