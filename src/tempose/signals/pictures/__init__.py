"""Pictures of signals: the pose plane, the poses that its places mean, errors and clocks."""

from tempose.signals.pictures.charts import draw_errors, draw_retiming, draw_scree
from tempose.signals.pictures.plot import bad_transitions, plot_signals, pose_grid
from tempose.signals.pictures.pose_grid import draw_pose_grid
from tempose.signals.pictures.pose_plane import draw_pose_plane

__all__ = [
    "bad_transitions",
    "draw_errors",
    "draw_pose_grid",
    "draw_pose_plane",
    "draw_retiming",
    "draw_scree",
    "plot_signals",
    "pose_grid",
]
