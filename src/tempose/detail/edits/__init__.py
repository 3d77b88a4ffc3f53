"""Edits of the detail itself: more of it or less, calmer, only here and there, on other proportions."""

from tempose.detail.edits.damping import damped
from tempose.detail.edits.masks import region_strengths, vertex_mask
from tempose.detail.edits.sizes import size_ratio

__all__ = ["damped", "region_strengths", "size_ratio", "vertex_mask"]
