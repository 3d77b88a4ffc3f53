"""Curves over a parameter: cubic B-splines and monotone maps, on plain arrays."""

from tempose.curves.monotone import MonotoneMap, monotone_map
from tempose.curves.spline import Spline, interpolating_spline

__all__ = ["MonotoneMap", "Spline", "interpolating_spline", "monotone_map"]
