"""A skeleton for every clip: rigs from meshes, clips and files, and the motion that follows a clip."""

from tempose.rigging.export import export_rig
from tempose.rigging.fit import fit_rig
from tempose.rigging.motions import match_motion
from tempose.rigging.proportions import change_proportions
from tempose.rigging.rig import Rig

__all__ = ["Rig", "change_proportions", "export_rig", "fit_rig", "match_motion"]
