"""Meshes of one topology as points of a Euclidean space: one file, or room, a shape space."""

from tempose.shape_spaces.edge_dihedral import EdgeDihedralSpace
from tempose.shape_spaces.gradient import GradientSpace
from tempose.shape_spaces.patch import PatchSpace
from tempose.shape_spaces.registry import SPACES, shape_space, space_from_state
from tempose.shape_spaces.rotation_invariant import RotationInvariantSpace
from tempose.shape_spaces.space import ShapeSpace
from tempose.shape_spaces.vertex import VertexSpace

__all__ = [
    "SPACES",
    "EdgeDihedralSpace",
    "GradientSpace",
    "PatchSpace",
    "RotationInvariantSpace",
    "ShapeSpace",
    "VertexSpace",
    "shape_space",
    "space_from_state",
]
