"""Which pose of the source is its reference."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import SkeletonClip
from tempose.rotations import angle_between
from tempose.transfer.bodies.bones import Bones, bone_spans
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.turns.alignment import limb_angles, stands_upright
from tempose.typing import FloatArray

LEG_WARNING_DEG = 40.0
_JUMP_DEG = 20.0
_MANY_BONES, _UNUSUAL = 8, 2.0


@dataclass(frozen=True)
class Reference:
    """The source in the pose that corresponds to the target's rest."""

    pose: BonePose
    """(B,) bones of the source."""
    upright: bool
    """Whether the trunk is straight, as in a T-pose; False for a frame picked out of the motion."""
    chosen: str
    """What was taken, for the report."""
    first_frame: int = 0
    """1 where frame 0 is not motion but a T-pose that a converter put there."""
    warnings: tuple[str, ...] = ()
    """What is doubtful about it."""


def bone_motion(clip: SkeletonClip, bones: Bones, roles: dict[str, int]) -> BonePose:
    """Bones of a source clip in the world.

    Parameters
    ----------
    clip : SkeletonClip
        T frames.
    bones : Bones
        B bones.
    roles : dict of str to int
        Body role to joint.

    Returns
    -------
    BonePose
        (T, B).
    """
    return BonePose(*bone_spans(clip.skeleton, bones.joints, roles, clip.rotations, clip.root_position))


def bone_rest(clip: SkeletonClip, bones: Bones, roles: dict[str, int]) -> BonePose:
    """Bones of a source skeleton in its own rest pose.

    Parameters
    ----------
    clip : SkeletonClip
        Its skeleton is looked at.
    bones : Bones
        B bones.
    roles : dict of str to int
        Body role to joint.

    Returns
    -------
    BonePose
        (B,).
    """
    skeleton = clip.skeleton
    rest = np.asarray(skeleton.rest_rotations)
    return BonePose(*bone_spans(skeleton, bones.joints, roles, rest, skeleton.offsets[0]))


def choose_reference(
    clip: SkeletonClip, bones: Bones, roles: dict[str, int], target: BonePose, frame: int | None = None
) -> Reference:
    """Choose the reference pose of a source.

    Parameters
    ----------
    clip : SkeletonClip
        The source, or another clip of the same skeleton that holds its reference.
    bones : Bones
        B bones.
    roles : dict of str to int
        Body role to joint.
    target : BonePose
        (B,) target at rest.
    frame : int, optional
        Frame that the user names.

    Returns
    -------
    Reference
        The named frame; else a T-pose in frame 0 that the clip jumps away from; else the rest pose of the
        skeleton if a body can stand so; else the frame whose bones come nearest to the target's.

    Raises
    ------
    ValueError
        If the named frame does not exist.
    """
    motion = bone_motion(clip, bones, roles)
    if frame is not None:
        if not 0 <= frame < clip.n_frames:
            raise ValueError(f"source_rest must be a frame from 0 to {clip.n_frames - 1}, got {frame}")
        pose = motion.frame(frame)
        return Reference(pose, True, f"frame {frame}", warnings=_doubts(bones, pose, target))
    rest = bone_rest(clip, bones, roles)
    if _starts_with_reference(motion, rest, bones):
        return Reference(motion.frame(0), True, "frame 0, a pose put before the motion", first_frame=1)
    if stands_upright(bones, rest):
        return Reference(rest, True, "rest pose of the skeleton")
    angles = limb_angles(bones, motion, target)
    best = int(angles.sum(axis=1).argmin())
    pose = motion.frame(best)
    return Reference(
        pose,
        False,
        f"frame {best}, whose bones come nearest to the target's rest",
        warnings=_doubts(bones, pose, target),
    )


def _starts_with_reference(motion: BonePose, rest: BonePose, bones: Bones) -> bool:
    if len(motion.turns) < 3:
        return False
    # the whole pose jumps: a single fast bone turns as far between frames that were thinned out
    turned = np.sort(np.degrees(angle_between(motion.turns[:-1], motion.turns[1:])), axis=1)
    steps = turned[:, -_MANY_BONES:].mean(axis=1)
    usual = float(np.percentile(steps[1:], 95))
    jumps = steps[0] > _JUMP_DEG and steps[0] > _UNUSUAL * usual
    return bool(jumps and stands_upright(bones, motion.frame(0)))


def _doubts(bones: Bones, pose: BonePose, target: BonePose) -> tuple[str, ...]:
    angles: FloatArray = np.degrees(limb_angles(bones, pose, target))
    legs = [
        b
        for b, role in enumerate(bones.roles)
        if role.endswith(("thigh", "shin")) and angles[b] > LEG_WARNING_DEG
    ]
    if not legs:
        return ()
    worst = max(legs, key=lambda b: float(angles[b]))
    return (
        f"reference pose: {bones.names[worst]} differs by {angles[worst]:.0f} degrees from the target's "
        "rest; name a standing T- or A-pose with source_rest",
    )
