"""Connected parts of a mesh, and what carries each of them along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from tempose.geometry import vertex_areas, vertex_components
from tempose.rotations import polar_rotation
from tempose.typing import FloatArray, IntArray

_ANCHOR = 24


@dataclass(frozen=True, eq=False)
class Part:
    """A connected part and the vertices whose motion it rides on."""

    vertices: IntArray
    """Its vertices."""
    weights: FloatArray
    """Weight of each in the frame of the part; they sum to 1."""
    anchor: IntArray
    """Vertices of the main part that carry it; empty for the main part itself."""
    rigid: bool
    """Whether it has faces, and so a rotation; a loose vertex has only a place."""


def find_parts(V: FloatArray, F: IntArray, weights: FloatArray) -> list[Part]:
    """Split a mesh into connected parts, that of the largest area first.

    Parameters
    ----------
    V : (n, 3) float
        Reference mesh, metres.
    F : (m, 3) int
        Faces.
    weights : (n,) float
        How much each vertex counts in the frame of its part, positive where there is a face.

    Returns
    -------
    list of Part
        Parts without faces, which are single vertices, come last.
    """
    n = len(V)
    _, labels = vertex_components(F, n)
    areas = np.bincount(labels, vertex_areas(V, F))
    has_faces = np.bincount(labels[F.ravel()], minlength=len(areas)) > 0
    order = np.lexsort((np.arange(len(areas)), -areas, ~has_faces))
    members = np.split(np.argsort(labels, kind="stable"), np.cumsum(np.bincount(labels))[:-1])
    main = members[order[0]]
    tree = KDTree(V[main])
    parts: list[Part] = []
    for rank, label in enumerate(order):
        own = members[label]
        w = weights[own] if has_faces[label] else np.ones(len(own))
        anchor = own[:0]
        if rank:
            count = min(len(main), max(_ANCHOR, len(own)))
            nearest = np.atleast_1d(tree.query(w @ V[own] / w.sum(), count)[1])
            anchor = main[np.sort(nearest)]
        parts.append(Part(own, w / w.sum(), anchor, bool(has_faces[label])))
    return parts


def steady_weights(V: FloatArray, F: IntArray, frames: FloatArray) -> FloatArray:
    """Weigh the vertices for the frame of their part: area, and more where a clip moves them most rigidly.

    Parameters
    ----------
    V : (n, 3) float
        Reference mesh.
    F : (m, 3) int
        Faces.
    frames : (T, n, 3) float
        Frames of a clip; of a single one nothing is learned.

    Returns
    -------
    (n,) ndarray
        Weights, free of units.

    Notes
    -----
    Iteratively reweighted alignment. A frame that follows the trunk, not swinging limbs, turns steadily, so
    that what lies between two frames is turned well too.
    """
    area = vertex_areas(V, F)
    area = area / max(area.sum(), 1e-300)
    if len(frames) < 2:
        return area
    weights = area
    _, labels = vertex_components(F, len(V))
    for _ in range(4):
        weights = np.where(area > 0, area * _steadiness(V, frames, weights, labels), 0.0)
    return weights / max(weights.sum(), 1e-300)


def _steadiness(V: FloatArray, frames: FloatArray, weights: FloatArray, labels: IntArray) -> FloatArray:
    factor = np.ones(len(V))
    for label in np.unique(labels):
        own = np.flatnonzero(labels == label)
        if len(own) < 4 or not weights[own].sum() > 0:
            continue
        squares = np.zeros(len(own))
        for X in frames:
            R, c, c0 = rigid_fit(V[own], X[own], weights[own])
            squares += np.sum(((V[own] - c0) @ R.T + c - X[own]) ** 2, axis=1)
        floor = np.quantile(squares, 0.25) + 1e-12 * squares.max() + 1e-300
        factor[own] = floor / (floor + squares)
    return factor


def rigid_fit(P: FloatArray, Q: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rotation and centres that bring `P` nearest to `Q`.

    Parameters
    ----------
    P, Q : (k, 3) float
        Corresponding points.
    weights : (k,) float
        Positive somewhere.

    Returns
    -------
    R : (3, 3) ndarray
        Rotation from `P` to `Q`.
    centre : (3,) ndarray
        Weighted centre of `Q`.
    centre_before : (3,) ndarray
        Weighted centre of `P`.
    """
    w = weights / weights.sum()
    c, c0 = w @ Q, w @ P
    return polar_rotation((Q - c).T @ ((P - c0) * w[:, None])), c, c0
