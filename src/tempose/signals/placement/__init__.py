"""The placement: where the body is and which way it is turned, apart from its shape."""

from tempose.signals.placement.pieces import GroundMotion, ground_motions, splice_placement
from tempose.signals.placement.place import in_body, place, placed
from tempose.signals.placement.spline import placement_at, placement_spline
from tempose.signals.placement.split import fit_placements, split_placement

__all__ = [
    "GroundMotion",
    "fit_placements",
    "ground_motions",
    "in_body",
    "place",
    "placed",
    "placement_at",
    "placement_spline",
    "splice_placement",
    "split_placement",
]
