"""The shape signal replaced: a clip's motion on another mesh, by pairs of example poses."""

from tempose.signals.replace_shape.mixtures import Mixtures, Products, best_mixtures
from tempose.signals.replace_shape.poses import PoseSet, load_poses, locate
from tempose.signals.replace_shape.replace import ShapeTransfer, replace_shape

__all__ = [
    "Mixtures",
    "PoseSet",
    "Products",
    "ShapeTransfer",
    "best_mixtures",
    "load_poses",
    "locate",
    "replace_shape",
]
