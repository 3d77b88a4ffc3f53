"""Skeletons in motion: forward kinematics, skinning, and which joint plays which part of a body."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tempose.kinematics.bone_axes import BoneEnd, bone_axis, bone_ends, role_lengths
from tempose.kinematics.bone_transforms import bone_transforms, local_rotations
from tempose.kinematics.forward import forward_kinematics, rest_motion, rest_transforms
from tempose.kinematics.roles import ROLES, bones_of_role, find_roles
from tempose.kinematics.sides import side_contradictions
from tempose.kinematics.skinning import linear_blend_skinning

if TYPE_CHECKING:
    from tempose.kinematics.dual_quaternion import dual_quaternion_skinning
    from tempose.kinematics.skin_kernel import SkinKernel

# compiled code takes a second to import, and most who need a skeleton do not need these
_COMPILED = {"SkinKernel": "skin_kernel", "dual_quaternion_skinning": "dual_quaternion"}

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
    "rest_motion",
    "rest_transforms",
    "role_lengths",
    "side_contradictions",
]


def __getattr__(name: str) -> Any:
    if name not in _COMPILED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_COMPILED[name]}"), name)
