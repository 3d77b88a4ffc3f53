"""Everything that makes one character, before it has a resolution."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from tempose.clips import Skeleton
from tempose.samples.field import Field, pack
from tempose.samples.parts import Node, Part
from tempose.samples.surface_nets import surface_nets
from tempose.samples.uv_charts import ChartRule
from tempose.typing import FloatArray, IntArray

STEP = 0.005
"""Grid cell of the first mesh, metres: the gaps between fingers must be seen."""


@dataclass(frozen=True, eq=False)
class Sculpture:
    """Solids, joints, and how the ones follow the others."""

    name: str
    """Name for a person to read."""
    nodes: tuple[Node, ...]
    """Limbs, parents first."""
    parts: tuple[Part, ...]
    """Solids."""
    skeleton: Skeleton
    """Joints in the rest pose."""
    softness: Mapping[str, float]
    """Half the width of the bend at each joint, metres."""
    special_weights: Mapping[str, Callable[[FloatArray], FloatArray]] = field(
        default_factory=dict[str, Callable[[FloatArray], FloatArray]]
    )
    """Nodes that no chain of joints moves: (n, 3) points to (n, J) weights."""
    regions: Mapping[str, tuple[str, Callable[[FloatArray], FloatArray]]] = field(
        default_factory=dict[str, tuple[str, Callable[[FloatArray], FloatArray]]]
    )
    """Soft regions: the node that is soft, and (n, 3) points to (n,) softness, 0 to 1."""

    charts: Mapping[str, ChartRule] = field(default_factory=dict[str, ChartRule])
    """How to cut the surface for a texture, by name of chart."""

    @cached_property
    def field(self) -> Field:
        """The implicit surface."""
        return pack(self.nodes, self.parts)

    @cached_property
    def first_mesh(self) -> tuple[FloatArray, IntArray]:
        """A dense mesh of it, to be remeshed."""
        bounds = np.array([part.bounds for part in self.parts if not part.carve])
        lower, upper = bounds[:, 0].min(axis=0) - 0.02, bounds[:, 1].max(axis=0) + 0.02
        return surface_nets(self.field, lower, upper, STEP)
