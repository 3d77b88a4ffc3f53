"""Edge lengths and dihedral angles as a shape space: measured, put together, refined."""

from tempose.shape_spaces.edge_dihedral.decoded import Decoded
from tempose.shape_spaces.edge_dihedral.space import EdgeDihedralSpace

__all__ = ["Decoded", "EdgeDihedralSpace"]
