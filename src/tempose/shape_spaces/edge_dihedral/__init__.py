"""Edge lengths and dihedral angles as a shape space: measured, put together, refined."""

from tempose.shape_spaces.edge_dihedral.space import Decoded, EdgeDihedralSpace

__all__ = ["Decoded", "EdgeDihedralSpace"]
