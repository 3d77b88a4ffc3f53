"""Bones of a clip by skinning decomposition: rigid bones, few and convex weights."""

from tempose.rigging.decomposition.decompose import Decomposition, decompose

__all__ = ["Decomposition", "decompose"]
