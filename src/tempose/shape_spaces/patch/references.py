"""The frames and steps from which the rotations of a clip are counted, wherever the body faces."""

from __future__ import annotations

import numpy as np

from tempose.rotations import from_matrix, polar_rotation, to_rotation_vector
from tempose.shape_spaces.gradient.branches import follow_path
from tempose.shape_spaces.gradient.faces import FaceGradients, padded
from tempose.shape_spaces.gradient.references import as_axes, as_rows, half_way
from tempose.typing import FloatArray


def body_frames(gradients: FaceGradients, frames: FloatArray) -> FloatArray:
    """Average the frames of faces over a clip from which the rotation of the whole is taken out.

    Parameters
    ----------
    gradients : FaceGradients
        The mesh at rest.
    frames : (T, n, 3) float
        Clip or poses, metres.

    Returns
    -------
    (9 m + 3,) ndarray
        Frames of the faces, the whole as it stands in the middle of the clip.
    """
    shares = gradients.shape.shares
    base, turned = gradients.frames(), gradients.frames()
    gradients.turned(frames[0], base, turned)
    first = as_axes(turned).copy()
    total, bodies = np.zeros(first.shape), np.zeros((len(frames), 3, 3))
    for t, V in enumerate(frames):
        gradients.turned(V, base, turned)
        axes = as_axes(turned)
        bodies[t] = polar_rotation(np.einsum("m,mij,mkj->ik", shares, axes, first))
        total += bodies[t].T @ axes
    return padded(as_rows(_middle(bodies) @ polar_rotation(total)))


def _middle(turns: FloatArray) -> FloatArray:
    """Rotation from which those of a path differ least: their mean, or the one half way of a long path."""
    cosines = (np.einsum("tij,tij->t", turns[1:], turns[:-1]) - 1) / 2
    way = half_way(np.arccos(np.clip(cosines, -1, 1)))
    choices = [polar_rotation(turns.sum(axis=0)), turns[way]]
    largest: list[float] = []
    for choice in choices:
        w = to_rotation_vector(from_matrix(choice.T @ turns))[:, :, None]
        follow_path(w, np.ones(1))
        largest.append(float(np.linalg.norm(w, axis=1).max()))
    return choices[int(np.argmin(largest))]
