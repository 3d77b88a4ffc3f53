"""A still mesh bound to a skeleton."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.clips._frozen import Frozen
from tempose.clips.mesh import Mesh
from tempose.clips.skeleton import Skeleton
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class SkinnedMesh(Frozen):
    """A mesh in its bind pose, the joints in it and the weights between them."""

    mesh: Mesh
    """The mesh in its bind pose."""
    skeleton: Skeleton
    """Joints whose rest pose is the bind pose."""
    weights: FloatArray
    """(n, J) float64, rows >= 0 that sum to 1; a row of zeros is a vertex bound to nothing."""

    def __post_init__(self) -> None:
        n, J = len(self.mesh.vertices), self.skeleton.n_joints
        weights = as_floats(self.weights, "weights", (n, J))
        sums = weights.sum(axis=1)
        bad = (np.abs(sums - 1) > 1e-3) & (sums != 0)
        if (weights < 0).any() or bad.any():
            v = int(np.argmax(bad | (weights < 0).any(axis=1)))
            raise ValueError(f"weights must be >= 0 and sum to 1 (or 0), got sum {sums[v]:.4g} at vertex {v}")
        object.__setattr__(self, "weights", read_only(weights))
