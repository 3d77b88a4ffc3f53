"""Detail learned on a small control mesh and carried back to the full one."""

from tempose.detail.multiresolution.control import ControlMesh, make_control
from tempose.detail.multiresolution.spread import spreading

__all__ = ["ControlMesh", "make_control", "spreading"]
