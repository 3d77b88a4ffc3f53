"""Measures: how far, how stretched, how flipped, how much volume, how much skate."""

from tempose.metrics.acceleration import AccelerationRatio, accelerations, foot_acceleration
from tempose.metrics.contacts import detect_contacts, velocities
from tempose.metrics.directions import DirectionError, direction_angles, limb_direction_errors
from tempose.metrics.distortion import Ratios, area_ratios, edge_ratios
from tempose.metrics.errors import ClipErrors, ErrorMeter, compare
from tempose.metrics.flips import flipped_faces, flipped_percent, folded_percent
from tempose.metrics.ground import Penetration, ground_depths, penetration
from tempose.metrics.patches import patch_round
from tempose.metrics.skate import skate, sole_velocities
from tempose.metrics.volume import (
    Enclosed,
    component_volume_change,
    component_volumes,
    volume_change,
    volumes,
)

__all__ = [
    "AccelerationRatio",
    "ClipErrors",
    "DirectionError",
    "Enclosed",
    "ErrorMeter",
    "Penetration",
    "Ratios",
    "accelerations",
    "area_ratios",
    "compare",
    "component_volume_change",
    "component_volumes",
    "detect_contacts",
    "direction_angles",
    "edge_ratios",
    "flipped_faces",
    "flipped_percent",
    "folded_percent",
    "foot_acceleration",
    "ground_depths",
    "limb_direction_errors",
    "patch_round",
    "penetration",
    "skate",
    "sole_velocities",
    "velocities",
    "volume_change",
    "volumes",
]
