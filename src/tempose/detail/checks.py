"""Checks of what a fit is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.detail.residuals import check_basis
from tempose.rigging import Rig
from tempose.rotations import angle_between

_ALIKE = 1e-3
"""Radians by which bases at rest may differ, as files round them."""


def check_options(model: Any, learners: Mapping[str, Any]) -> None:
    """Check the arguments of the constructor of a model.

    Parameters
    ----------
    model : DetailModel
        Holds them.
    learners : mapping
        Names that are known.

    Raises
    ------
    ValueError
        If one is out of its range.
    """
    check_basis(model.basis)
    if isinstance(model.learner, str) and model.learner != "auto" and model.learner not in learners:
        raise ValueError(f"learner must be auto, {', '.join(learners)}, got {model.learner!r}")
    if not 0 < model.tolerance < float("inf"):
        raise ValueError(f"tolerance must be a positive percentage of the diagonal, got {model.tolerance}")
    if model.resolution is not None and not 0 < model.resolution <= 100:
        raise ValueError(f"resolution must be above 0 and at most 100 percent, got {model.resolution}")
    if model.folds != 0 and model.folds < 2:
        raise ValueError(f"folds must be 0 or 2 and more, got {model.folds}")


def check_clips(clips: Sequence[MeshClip], rig: Rig, motions: Sequence[SkeletonClip] | None) -> None:
    """Check that clips, rig and motions belong together.

    Parameters
    ----------
    clips : sequence of MeshClip
        To learn from.
    rig : Rig
        Skin and skeleton.
    motions : sequence of SkeletonClip, optional
        One for each clip.

    Raises
    ------
    ValueError
        If they do not.
    """
    if not clips:
        raise ValueError("clips must hold one clip or more, got none")
    n = len(rig.skin.mesh.vertices)
    for i, clip in enumerate(clips):
        if len(clip.rest) != n:
            raise ValueError(f"clips[{i}] must have the {n} vertices of the rig, got {len(clip.rest)}")
        if clip.n_frames == 0:
            raise ValueError(f"clips[{i}] must have one frame or more, got none")
    if motions is None:
        return
    if len(motions) != len(clips):
        raise ValueError(f"motions must hold one for each of {len(clips)} clips, got {len(motions)}")
    for i, (clip, motion) in enumerate(zip(clips, motions)):
        check_joints(rig, motion, f"motions[{i}]")
        if motion.n_frames != clip.n_frames:
            raise ValueError(
                f"motions[{i}] must have the {clip.n_frames} frames of its clip, got {motion.n_frames}"
            )


def check_joints(rig: Rig, motion: SkeletonClip, name: str = "motion") -> None:
    """Check that a motion moves the joints of a rig, from the same bases.

    Parameters
    ----------
    rig : Rig
        Skin and skeleton.
    motion : SkeletonClip
        Its bones may have other lengths.
    name : str, default "motion"
        Name of the argument, for the message.

    Raises
    ------
    ValueError
        If it moves other joints, or they hang or rest otherwise: its rotations then mean another pose.
    """
    ours, theirs = rig.skin.skeleton, motion.skeleton
    way = "tempose.rigging.motions.match_motion brings other skeletons onto them"
    if theirs.names != ours.names:
        odd = [joint for joint in theirs.names if joint not in ours.names]
        what = f"unknown {odd[0]!r}" if odd else f"{theirs.n_joints} of {ours.n_joints} in their order"
        some = ", ".join(ours.names[:3])
        raise ValueError(f"{name} must move the joints of the rig, {some}..., got {what}; {way}")
    wrong = np.flatnonzero(theirs.parents != ours.parents)
    if len(wrong):
        raise ValueError(f"{name} must hang {ours.names[wrong[0]]!r} on the joint that the rig does; {way}")
    assert ours.rest_rotations is not None and theirs.rest_rotations is not None
    turned = angle_between(theirs.rest_rotations, ours.rest_rotations)
    far = int(turned.argmax())
    if turned[far] > _ALIKE:
        raise ValueError(
            f"{name} must rest as the rig does, got {ours.names[far]!r} turned by "
            f"{np.degrees(turned[far]):.3g} degrees; {way}"
        )
