"""A skeleton for every clip: rigs from meshes, clips and files, and the motion that follows a clip."""

from tempose.rigging.fit import fit_rig
from tempose.rigging.rig import Rig

__all__ = ["Rig", "fit_rig"]
