"""Meshes of one topology as points of a Euclidean space: one file, or room, a shape space."""

from tempose.shape_spaces.gradient import GradientSpace
from tempose.shape_spaces.patch import PatchSpace
from tempose.shape_spaces.registry import SPACES, shape_space, space_from_state
from tempose.shape_spaces.space import ShapeSpace
from tempose.shape_spaces.vertex import VertexSpace

__all__ = [
    "SPACES",
    "GradientSpace",
    "PatchSpace",
    "ShapeSpace",
    "VertexSpace",
    "shape_space",
    "space_from_state",
]
