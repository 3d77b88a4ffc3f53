"""Skeletons in motion: forward kinematics and skinning."""

from tempose.kinematics.forward import forward_kinematics, rest_transforms
from tempose.kinematics.skinning import linear_blend_skinning

__all__ = ["forward_kinematics", "linear_blend_skinning", "rest_transforms"]
