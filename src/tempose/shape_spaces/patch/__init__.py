"""Deformation gradients against the rotations of patches, so that the whole may turn."""

from tempose.shape_spaces.patch.space import PatchSpace

__all__ = ["PatchSpace"]
