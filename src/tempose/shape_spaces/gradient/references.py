"""The frames from which a clip's rotations are counted."""

from __future__ import annotations

import numpy as np

from tempose.rotations import polar_rotation
from tempose.shape_spaces.gradient.branches import follow_branch
from tempose.shape_spaces.gradient.faces import FaceGradients, padded
from tempose.typing import BoolArray, FloatArray

FAR = np.radians(150.0)
"""A face that gets further than this from its mean rotation may turn on and on."""


def reference_frames(gradients: FaceGradients, frames: FloatArray) -> FloatArray:
    """Choose the rotations of faces from which those of a clip differ least.

    Parameters
    ----------
    gradients : FaceGradients
        The mesh at rest.
    frames : (T, n, 3) float
        Clip or poses, metres; read frame by frame, some times over.

    Returns
    -------
    (9 m + 3,) ndarray
        Turned frames of the faces: the mean over the clip; for faces that leave it by nearly half a turn
        the frame half way of their path, where that keeps their angles smaller.
    """
    base, turned = gradients.frames(), gradients.frames()
    total = np.zeros(base.shape)
    for V in frames:
        gradients.turned(V, base, turned)
        total += turned
    mean = padded(as_rows(polar_rotation(as_axes(total))))
    far = _far_faces(gradients, frames, mean)
    if not far.any():
        return mean
    middle = _middle_frame(gradients, frames, far)
    gradients.turned(frames[middle], mean, turned)
    angles = [_largest_angles(gradients, frames, middle, reference) for reference in (turned, mean)]
    better = far & (angles[0] < angles[1])
    return padded(np.where(better, turned[:-3].reshape(9, -1), mean[:-3].reshape(9, -1)))


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


def half_way(steps: FloatArray) -> int:
    """Find the frame before which half of a way is made.

    Parameters
    ----------
    steps : (T - 1,) float
        Way from frame to frame, not negative.

    Returns
    -------
    int
        Frame.
    """
    way = np.concatenate([[0.0], np.cumsum(steps)])
    return int(np.abs(way - way[-1] / 2).argmin())


def _far_faces(gradients: FaceGradients, frames: FloatArray, mean: FloatArray) -> BoolArray:
    least, turned = np.full(gradients.n_faces, 3.0), gradients.frames()
    for V in frames:
        gradients.turned(V, mean, turned)
        least = np.minimum(least, _traces(turned, mean))
    return least < 1 + 2 * np.cos(FAR)


def _middle_frame(gradients: FaceGradients, frames: FloatArray, far: BoolArray) -> int:
    weights = gradients.shape.shares * far
    turned, before = gradients.frames(), gradients.frames()
    steps = np.zeros(len(frames))
    for t, V in enumerate(frames):
        gradients.turned(V, before, turned)
        steps[t] = np.arccos(np.clip((_traces(turned, before) - 1) / 2, -1.0, 1.0)) @ weights
        turned, before = before, turned
    return half_way(steps[1:])


def _traces(a: FloatArray, b: FloatArray) -> FloatArray:
    return (a * b)[:-3].reshape(9, -1).sum(axis=0)


def _largest_angles(
    gradients: FaceGradients, frames: FloatArray, start: int, reference: FloatArray
) -> FloatArray:
    """Largest angle of every face from a reference, going on from a frame in both directions."""
    m, weigh = gradients.n_faces, gradients.weigh
    z, before = (np.zeros(9 * m + 3 * gradients.n_pieces) for _ in range(2))
    largest = np.zeros(m)
    for order in (range(start, len(frames)), range(start, -1, -1)):
        for t in order:
            gradients.encode(frames[t], reference, z)
            w = z[: 3 * m].reshape(3, m)
            if t != start:
                follow_branch(before[: 3 * m].reshape(3, m), weigh, w)
            largest = np.maximum(largest, np.sqrt((w * w).sum(axis=0)) * weigh[:m])
            z, before = before, z
    return largest
