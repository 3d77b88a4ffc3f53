"""The shape signal h(x) = h_0 + H x, from the shape subspace to meshes (section 2.1 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.shape_spaces import ShapeSpace
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class ShapeSignal:
    """An affine subspace of a shape space."""

    space: ShapeSpace
    """Where the meshes live."""
    mean: FloatArray
    """(d,) h_0."""
    components: FloatArray
    """(m, d) the columns of H, as rows; orthonormal unless made from examples."""

    def vertices(self, x: FloatArray) -> FloatArray:
        """Return the meshes at shape coordinates.

        Parameters
        ----------
        x : (..., m) float
            Shape coordinates.

        Returns
        -------
        (..., n, 3) ndarray
            Vertex positions, metres.
        """
        return self.space.decode(self.mean + np.asarray(x) @ self.components)
