"""Linear rotation-invariant coordinates as a shape space: heights over tangent planes, and their signs."""

from tempose.shape_spaces.rotation_invariant.space import RotationInvariantSpace

__all__ = ["RotationInvariantSpace"]
