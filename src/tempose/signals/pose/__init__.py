"""The pose signal g: from the plane of poses to shape coordinates; where the frames lie in that plane."""

from tempose.signals.pose.choose import LayoutChoice, choose_layout
from tempose.signals.pose.curvature import gaussian_curvature
from tempose.signals.pose.densified import densified_order, densified_pose_signal
from tempose.signals.pose.fit import fit_pose_signal
from tempose.signals.pose.layout import LayoutResult, PoseLayout
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.pose.sites import SiteOrder, order_sites
from tempose.signals.pose.transitions import Transitions, find_bad_transitions

__all__ = [
    "LayoutChoice",
    "LayoutResult",
    "PoseLayout",
    "PoseSignal",
    "SiteOrder",
    "Transitions",
    "choose_layout",
    "densified_order",
    "densified_pose_signal",
    "find_bad_transitions",
    "fit_pose_signal",
    "gaussian_curvature",
    "order_sites",
]
