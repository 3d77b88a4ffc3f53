"""Edge lengths and dihedral angles as a shape space: measured, put together, refined."""

from tempose.shape_spaces.edge_dihedral.space import EdgeDihedralSpace

__all__ = ["EdgeDihedralSpace"]
