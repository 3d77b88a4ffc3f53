"""The shape signal h(x) = h_0 + H x, from the shape subspace to meshes (section 2.1 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.shape_spaces import ShapeSpace, VertexSpace
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

    def __post_init__(self) -> None:
        components = as_floats(self.components, "components", ("m", "d"))
        mean = as_floats(self.mean, "mean", (self.space.dimension,))
        if components.shape[1] != len(mean):
            raise ValueError(f"components must have shape (m, {len(mean)}), got {components.shape}")
        object.__setattr__(self, "mean", read_only(mean))
        object.__setattr__(self, "components", read_only(components))

    def vertices(self, x: FloatArray, dtype: Any = np.float64, out: FloatArray | None = None) -> FloatArray:
        """Return the meshes at shape coordinates.

        Parameters
        ----------
        x : (..., m) float
            Shape coordinates.
        dtype : dtype, default float64
            Of the result; float32 is also computed so where coordinates are vertices, many times faster.
        out : (..., n, 3) array, optional
            Where to write; then its type counts.

        Returns
        -------
        (..., n, 3) ndarray
            Vertex positions, metres.
        """
        x = np.asarray(x, dtype=np.float64)
        dtype = np.dtype(dtype) if out is None else out.dtype
        if dtype == np.float32 and isinstance(self.space, VertexSpace):
            return self._single_vertices(x, out)
        V = self.space.decode(self.mean + x @ self.components)
        if out is None:
            return V.astype(dtype, copy=False)
        out[...] = V
        return out

    @cached_property
    def _single(self) -> FloatArray:
        """(m + 1, d) float32: the components, then the mean, so that one product gives the vertices."""
        return np.concatenate([self.components, self.mean[None]]).astype(np.float32)

    def _single_vertices(self, x: FloatArray, out: FloatArray | None) -> FloatArray:
        shape = (*x.shape[:-1], self.space.n_vertices, 3)
        factors = np.ones((*x.shape[:-1], x.shape[-1] + 1), np.float32)
        factors[..., :-1] = x
        if out is None or not out.flags.c_contiguous:
            V = (factors @ self._single).reshape(shape)
            if out is None:
                return V
            out[...] = V
        else:
            np.matmul(factors, self._single, out=out.reshape(*shape[:-2], -1))
        return out
