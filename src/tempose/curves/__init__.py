"""Curves over a parameter: cubic B-splines and monotone maps, on plain arrays."""

from tempose.curves.interpolation import interpolating_spline
from tempose.curves.join import join_maps, join_splines
from tempose.curves.monotone import MonotoneMap, monotone_map
from tempose.curves.refine import insert_knots, slice_spline
from tempose.curves.splicing import Seam, splice_spline
from tempose.curves.spline import Spline

__all__ = [
    "MonotoneMap",
    "Seam",
    "Spline",
    "insert_knots",
    "interpolating_spline",
    "join_maps",
    "join_splines",
    "monotone_map",
    "slice_spline",
    "splice_spline",
]
