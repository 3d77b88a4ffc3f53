"""Deformation gradients of faces as coordinates: a rotation vector and a symmetric stretch each."""

from tempose.shape_spaces.gradient.space import GradientSpace

__all__ = ["GradientSpace"]
