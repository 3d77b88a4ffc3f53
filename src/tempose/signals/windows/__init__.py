"""Long clips: the pose plane laid out by key frames, the pose signal fitted window by window."""

from tempose.signals.windows.cover import Cover, cover
from tempose.signals.windows.fit import WindowedFit, fit_dense_windows, fit_windowed_pose, fit_windows
from tempose.signals.windows.layout import LongLayout, long_layout, place_frames
from tempose.signals.windows.pose import WindowedPose

__all__ = [
    "Cover",
    "LongLayout",
    "WindowedFit",
    "WindowedPose",
    "cover",
    "fit_dense_windows",
    "fit_windowed_pose",
    "fit_windows",
    "long_layout",
    "place_frames",
]
