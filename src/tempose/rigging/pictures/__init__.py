"""Pictures of rigs: the skeleton in its mesh, weights, how the skin follows the clip."""

from tempose.rigging.pictures.bones import bone_lines
from tempose.rigging.pictures.charts import draw_frame_errors
from tempose.rigging.pictures.plot import plot_rig, rig_sheet
from tempose.rigging.pictures.weights import weight_colors

__all__ = ["bone_lines", "draw_frame_errors", "plot_rig", "rig_sheet", "weight_colors"]
