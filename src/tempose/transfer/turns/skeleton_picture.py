"""A skeleton's motion as something that can be looked at."""

from __future__ import annotations

from tempose.clips import MeshClip, SkeletonClip
from tempose.kinematics.roles import find_roles
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.bodies.template import template_clip
from tempose.transfer.turns.reference import bone_motion


def skeleton_mesh(clip: SkeletonClip, mapping: dict[str, str] | None = None) -> MeshClip:
    """Give every joint of a skeleton a closed bone and carry the bones through the motion.

    Parameters
    ----------
    clip : SkeletonClip
        T frames of J joints.
    mapping : dict of str to str, optional
        Joint to body role, where the names do not tell.

    Returns
    -------
    MeshClip
        T frames, metres; a group of faces a joint.
    """
    roles = find_roles(clip.skeleton, mapping)
    bones = make_bones(clip.skeleton, clip.skeleton.names, roles)
    return template_clip(bones.names, bone_motion(clip, bones, roles), clip.fps, clip.name or "skeleton")
