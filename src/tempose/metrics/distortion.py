"""Stretch and squeeze: lengths of edges and areas of faces against the rest pose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.clips.blocks import read_block
from tempose.geometry import edge_list
from tempose.metrics._frames import block_slices, check_clip
from tempose.metrics._tails import UpperTail
from tempose.metrics._triangles import area_vectors, coordinates, differences, dot
from tempose.typing import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Ratios:
    """Spread of posed over rest size, over all frames together; 1 is undistorted."""

    min: float
    """The most squeezed."""
    p1: float
    """1st percentile."""
    p99: float
    """99th percentile."""
    max: float
    """The most stretched."""


def edge_ratios(
    V: FloatArray,
    F: IntArray,
    V_rest: FloatArray,
    *,
    faces: BoolArray | None = None,
    vertices: BoolArray | None = None,
) -> Ratios:
    """Length of the edges against the rest pose.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.
    faces : (m,) bool, optional
        Only edges of these faces count.
    vertices : (n,) bool, optional
        Only edges with both ends among these count.

    Returns
    -------
    Ratios
        Edges without length at rest are left out.

    Raises
    ------
    ValueError
        If a shape is wrong, the clip is empty or holds NaN, or no edge is left.

    Notes
    -----
    Invariant to rigid motion of either pose; a uniform scale by s of the clip multiplies every number by s.
    """
    V, F, V_rest = _check(V, F, V_rest)
    F = _masked_faces(F, faces)
    edges = edge_list(F) if len(F) else np.zeros((0, 2), dtype=np.int32)
    if vertices is not None:
        edges = edges[_mask(vertices, len(V_rest), "vertices")[edges].all(axis=1)]

    def lengths(frames: FloatArray) -> FloatArray:
        edge = differences(coordinates(frames), edges[:, 0], edges[:, 1])
        return np.sqrt(dot(edge, edge))

    return _ratios(V, lengths, lengths(V_rest), 6 * len(edges), "edge")


def area_ratios(V: FloatArray, F: IntArray, V_rest: FloatArray, *, faces: BoolArray | None = None) -> Ratios:
    """Area of the faces against the rest pose.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.
    faces : (m,) bool, optional
        Only these faces count.

    Returns
    -------
    Ratios
        Faces without area at rest are left out.

    Raises
    ------
    ValueError
        If a shape is wrong, the clip is empty or holds NaN, or no face is left.
    """
    V, F, V_rest = _check(V, F, V_rest)
    F = _masked_faces(F, faces)

    def areas(frames: FloatArray) -> FloatArray:
        N, _ = area_vectors(coordinates(frames), F)
        return np.sqrt(dot(N, N)) / 2

    return _ratios(V, areas, areas(V_rest), 12 * len(F), "face")


def _ratios(
    V: Any, measure: Callable[[FloatArray], FloatArray], rest: FloatArray, values: int, what: str
) -> Ratios:
    sized = rest > 0
    count = len(V) * int(sized.sum())
    if count == 0:
        raise ValueError(f"F must leave at least one {what} with a size at rest, got none of {len(rest)}")
    high, low = UpperTail(count, 99), UpperTail(count, 99)
    for frames in block_slices(len(V), max(values, 3 * V.shape[1])):
        ratio = measure(read_block(V, frames, "V"))[:, sized] / rest[sized]
        high.add(ratio)
        low.add(-ratio)
    return Ratios(-low.maximum, -low.percentile, high.percentile, high.maximum)


def _check(V: Any, F: Any, V_rest: Any) -> tuple[Any, IntArray, FloatArray]:
    V = check_clip(V, "V")
    n = V.shape[1]
    return V, as_indices(F, "F", ("m", 3), limit=n), as_floats(V_rest, "V_rest", (n, 3))


def _masked_faces(F: IntArray, faces: Any) -> IntArray:
    return F if faces is None else F[_mask(faces, len(F), "faces")]


def _mask(mask: Any, length: int, name: str) -> BoolArray:
    mask = np.asarray(mask)
    if mask.dtype != np.bool_ or mask.shape != (length,):
        raise ValueError(f"{name} must be bool of shape ({length},), got {mask.dtype} of shape {mask.shape}")
    return mask
