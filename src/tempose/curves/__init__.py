"""Curves over a parameter: cubic B-splines and monotone maps, on plain arrays."""

from tempose.curves.fitting import determines, least_squares_spline
from tempose.curves.interpolation import interpolating_spline, periodic_spline
from tempose.curves.join import join_maps, join_splines
from tempose.curves.monotone import MonotoneMap, monotone_map
from tempose.curves.refine import insert_knots, slice_spline
from tempose.curves.splicing import Seam, splice_spline
from tempose.curves.spline import Spline

__all__ = [
    "MonotoneMap",
    "Seam",
    "Spline",
    "determines",
    "insert_knots",
    "interpolating_spline",
    "join_maps",
    "join_splines",
    "least_squares_spline",
    "monotone_map",
    "periodic_spline",
    "slice_spline",
    "splice_spline",
]
