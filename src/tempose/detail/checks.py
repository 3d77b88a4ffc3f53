"""Checks of what a fit is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tempose.clips import MeshClip, SkeletonClip
from tempose.detail.residuals import check_basis
from tempose.rigging import Rig


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
    n, names = len(rig.skin.mesh.vertices), rig.skin.skeleton.names
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
        if motion.skeleton.names != names:
            raise ValueError(f"motions[{i}] must move the joints of the rig, {', '.join(names[:3])}...")
        if motion.n_frames != clip.n_frames:
            raise ValueError(
                f"motions[{i}] must have the {clip.n_frames} frames of its clip, got {motion.n_frames}"
            )
