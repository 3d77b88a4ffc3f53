"""The frames from which a clip's rotations are counted."""

from __future__ import annotations

import numpy as np

from tempose.rotations import from_matrix, polar_rotation, to_rotation_vector
from tempose.shape_spaces.gradient.branches import follow_path
from tempose.shape_spaces.gradient.faces import FaceGradients, padded
from tempose.typing import FloatArray, IntArray

FAR = np.radians(150.0)
"""A face that gets further than this from its mean rotation may turn on and on."""


def reference_frames(gradients: FaceGradients, frames: FloatArray) -> FloatArray:
    """Choose the rotations of faces from which those of a clip differ least.

    Parameters
    ----------
    gradients : FaceGradients
        The mesh at rest.
    frames : (T, n, 3) float
        Clip or poses, metres.

    Returns
    -------
    (9 m + 3,) ndarray
        Turned frames of the faces: the mean over the clip; for faces that leave it by nearly half a turn
        the frame half way of their path, where that keeps their angles smaller.
    """
    total, turned = gradients.frames(), gradients.frames()
    base = gradients.frames()
    total[:] = 0.0
    for V in frames:
        gradients.turned(V, base, turned)
        total += turned
    mean = padded(as_rows(polar_rotation(as_axes(total))))
    far = _far_faces(gradients, frames, mean)
    if len(far) == 0:
        return mean
    axes = np.stack([_turned_axes(gradients, V, mean)[far] for V in frames])
    found = np.array(as_axes(mean))
    found[far] = middle_rotations(axes, gradients.shape.shares[far])
    return padded(as_rows(found))


def middle_rotations(axes: FloatArray, weights: FloatArray) -> FloatArray:
    """Choose rotations from which those of paths differ least.

    Parameters
    ----------
    axes : (T, k, 3, 3) float
        k rotations in the order of time.
    weights : (k,) float
        How much each counts for where the middle of the way is.

    Returns
    -------
    (k, 3, 3) ndarray
        The mean of each, or its rotation half way where its unwrapped angles then stay smaller.
    """
    mean, middle = polar_rotation(axes.sum(axis=0)), axes[_half_way(axes, weights)]
    better = _largest_angles(axes, middle) < _largest_angles(axes, mean)
    return np.where(better[:, None, None], middle, mean)


def as_axes(frames: FloatArray) -> FloatArray:
    """Read rows of frames as matrices.

    Parameters
    ----------
    frames : (9 m + 3,) float
        Frames.

    Returns
    -------
    (m, 3, 3) ndarray
        Axes in columns.
    """
    return frames[:-3].reshape(3, 3, -1).transpose(2, 1, 0)


def as_rows(axes: FloatArray) -> FloatArray:
    """Lay matrices out in rows.

    Parameters
    ----------
    axes : (m, 3, 3) float
        Axes in columns.

    Returns
    -------
    (9, m) ndarray
        Rows of frames.
    """
    return np.ascontiguousarray(axes.transpose(2, 1, 0)).reshape(9, -1)


def _turned_axes(gradients: FaceGradients, V: FloatArray, near: FloatArray) -> FloatArray:
    turned = gradients.frames()
    gradients.turned(V, near, turned)
    return as_axes(turned)


def _far_faces(gradients: FaceGradients, frames: FloatArray, mean: FloatArray) -> IntArray:
    least = np.full(gradients.n_faces, 3.0)
    turned = gradients.frames()
    for V in frames:
        gradients.turned(V, mean, turned)
        trace = (turned * mean)[:-3].reshape(9, -1).sum(axis=0)
        least = np.minimum(least, trace)
    return np.flatnonzero(least < 1 + 2 * np.cos(FAR))


def _half_way(axes: FloatArray, weights: FloatArray) -> int:
    """Frame at which the faces have made half their way."""
    cosine = (np.einsum("tfij,tfij->tf", axes[1:], axes[:-1]) - 1) / 2
    steps = np.arccos(np.clip(cosine, -1, 1)) @ weights
    way = np.concatenate([[0.0], np.cumsum(steps)])
    return int(np.abs(way - way[-1] / 2).argmin())


def _largest_angles(axes: FloatArray, reference: FloatArray) -> FloatArray:
    w = to_rotation_vector(from_matrix(np.einsum("fji,tfjk->tfik", reference, axes)))
    w = np.ascontiguousarray(w.transpose(0, 2, 1))
    follow_path(w, np.ones(w.shape[2]))
    return np.sqrt((w**2).sum(axis=1)).max(axis=0)
