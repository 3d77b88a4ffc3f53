"""Detail learned on a small control mesh and carried back to the full one."""

from tempose.detail.multiresolution.coarse import CoarseBasis, coarse_basis
from tempose.detail.multiresolution.control import ControlMesh, make_control, way_up
from tempose.detail.multiresolution.spread import spreading

__all__ = ["CoarseBasis", "ControlMesh", "coarse_basis", "make_control", "spreading", "way_up"]
