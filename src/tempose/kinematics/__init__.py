"""Skeletons in motion: forward kinematics, skinning, and which joint plays which part of a body."""

from tempose.kinematics.bone_axes import BoneEnd, bone_axis, bone_ends, role_lengths
from tempose.kinematics.bone_transforms import bone_transforms, local_rotations
from tempose.kinematics.dual_quaternion import dual_quaternion_skinning
from tempose.kinematics.forward import forward_kinematics, rest_transforms
from tempose.kinematics.roles import ROLES, bones_of_role, find_roles
from tempose.kinematics.sides import side_contradictions
from tempose.kinematics.skin_kernel import SkinKernel
from tempose.kinematics.skinning import linear_blend_skinning

__all__ = [
    "ROLES",
    "BoneEnd",
    "SkinKernel",
    "bone_axis",
    "bone_ends",
    "bone_transforms",
    "bones_of_role",
    "dual_quaternion_skinning",
    "find_roles",
    "forward_kinematics",
    "linear_blend_skinning",
    "local_rotations",
    "rest_transforms",
    "role_lengths",
    "side_contradictions",
]
