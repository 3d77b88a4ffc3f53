"""Triangles turned inside out, and folds between two of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.clips.blocks import read_block
from tempose.metrics._frames import block_slices, check_clip
from tempose.metrics._triangles import Vectors, area_vectors, coordinates, cross, dot, take
from tempose.typing import BoolArray, FloatArray, IntArray

_SLIVER = 2e-10  # double area over squared longest edge below which a normal is noise


def flipped_faces(V: FloatArray, F: IntArray, V_rest: FloatArray, rotations: FloatArray) -> BoolArray:
    """Faces whose normal points away from where their own rotation should have taken it.

    Parameters
    ----------
    V : (..., n, 3) float
        Posed vertices.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.
    rotations : (..., m, 4) float
        Rotation prescribed for each face, unit quaternions wxyz.

    Returns
    -------
    (..., m) ndarray of bool
        False for faces degenerate at rest or posed.
    """
    rest, sound_at_rest = _normals(V_rest, F)
    posed, sound = _normals(V, F)
    return (dot(_rotate(rotations, rest), posed) < 0) & sound & sound_at_rest


def _normals(V: FloatArray, F: IntArray) -> tuple[Vectors, BoolArray]:
    """Find normals as long as twice the area, and which of them are more than rounding."""
    N, longest = area_vectors(coordinates(V), F)
    return N, dot(N, N) > np.square(_SLIVER * longest)


def _unit_normals(V: FloatArray, F: IntArray) -> Vectors:
    N, sound = _normals(V, F)
    scale = 1 / np.sqrt(np.where(sound, dot(N, N), np.inf))
    return N[0] * scale, N[1] * scale, N[2] * scale


def _rotate(q: FloatArray, v: Vectors) -> Vectors:
    w, x, y, z = (q[..., k] for k in range(4))
    u = (x, y, z)
    t = cross(u, v)
    t = (2 * t[0], 2 * t[1], 2 * t[2])
    s = cross(u, t)
    return v[0] + w * t[0] + s[0], v[1] + w * t[1] + s[1], v[2] + w * t[2] + s[2]


def flipped_percent(V: FloatArray, F: IntArray, V_rest: FloatArray, rotations: FloatArray) -> FloatArray:
    """Share of flipped faces in each frame.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.
    rotations : (T, m, 4) float
        Rotation prescribed for each face, unit quaternions wxyz; an array or a memory map.

    Returns
    -------
    (T,) ndarray
        Percent of the faces that are not degenerate at rest; 0 where there are none.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or a quaternion has not unit length.
    """
    V, F, V_rest = _check(V, F, V_rest)
    if np.shape(rotations) != (len(V), len(F), 4):
        raise ValueError(f"rotations must have shape ({len(V)}, {len(F)}, 4), got {np.shape(rotations)}")
    counted = max(int(_normals(V_rest, F)[1].sum()), 1)
    percent = np.zeros(len(V))
    for frames in block_slices(len(V), 24 * len(F) + V.shape[1]):
        turns = as_floats(rotations[frames], "rotations", ("T", len(F), 4))
        if turns.size and np.abs(np.linalg.norm(turns, axis=-1) - 1).max() > 1e-3:
            raise ValueError("rotations must be unit quaternions wxyz, got another length")
        flipped = flipped_faces(read_block(V, frames, "V"), F, V_rest, turns)
        percent[frames] = 100 * flipped.sum(axis=1) / counted
    return percent


def folded_percent(V: FloatArray, F: IntArray, V_rest: FloatArray, threshold: float = -0.5) -> FloatArray:
    """Share of interior edges that are folded in a frame and not at rest.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.
    threshold : float, default -0.5
        An edge is folded when the dot product of its two unit normals is below this (120 degrees).

    Returns
    -------
    (T,) ndarray
        Percent of the edges that have two faces, both sound at rest; 0 where there are none.

    Raises
    ------
    ValueError
        If a shape is wrong, or a value is not finite.

    Notes
    -----
    Faces of opposite orientation are compared as if they agreed. Invariant to rigid motion and scale.
    """
    V, F, V_rest = _check(V, F, V_rest)
    pairs, sign = _face_pairs(F)
    sound = _normals(V_rest, F)[1][pairs].all(axis=1)
    pairs, sign = pairs[sound], sign[sound]
    unfolded = ~_folded(V_rest, F, pairs, sign, threshold)
    percent = np.zeros(len(V))
    for frames in block_slices(len(V), 24 * len(F) + V.shape[1]):
        folded = _folded(read_block(V, frames, "V"), F, pairs, sign, threshold) & unfolded
        percent[frames] = 100 * folded.sum(axis=1) / max(len(pairs), 1)
    return percent


def _folded(V: FloatArray, F: IntArray, pairs: IntArray, sign: FloatArray, threshold: float) -> BoolArray:
    N = _unit_normals(V, F)
    # a degenerate face has a zero normal here, which is folded against nothing
    return sign * dot(take(N, pairs[:, 0]), take(N, pairs[:, 1])) < threshold


def _face_pairs(F: IntArray) -> tuple[IntArray, FloatArray]:
    """Find both faces of every edge that has exactly two, and -1 where their orientations disagree."""
    a, b = F.ravel(), np.roll(F, -1, axis=1).ravel()
    key = np.minimum(a, b).astype(np.int64) * (int(F.max(initial=0)) + 1) + np.maximum(a, b)
    order = np.argsort(key, kind="stable")
    _, first, count = np.unique(key[order], return_index=True, return_counts=True)
    start = first[count == 2]
    half_edges = np.column_stack([order[start], order[start + 1]]) if len(start) else np.zeros((0, 2), int)
    rises = (a < b)[half_edges]
    return half_edges // 3, np.where(rises[:, 0] == rises[:, 1], -1.0, 1.0)


def _check(V: Any, F: Any, V_rest: Any) -> tuple[Any, IntArray, FloatArray]:
    V = check_clip(V, "V")
    n = V.shape[1]
    return V, as_indices(F, "F", ("m", 3), limit=n), as_floats(V_rest, "V_rest", (n, 3))
