"""Bones of a clip by skinning decomposition: rigid bones, few and convex weights."""

from tempose.rigging.decomposition.count import count_bones
from tempose.rigging.decomposition.decompose import Decomposition, decompose
from tempose.rigging.decomposition.weights import weights_for

__all__ = ["Decomposition", "count_bones", "decompose", "weights_for"]
