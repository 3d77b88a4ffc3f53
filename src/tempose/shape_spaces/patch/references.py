"""The frames and steps from which the rotations of a clip are counted, wherever the body faces."""

from __future__ import annotations

import numpy as np

from tempose.rotations import polar_rotation
from tempose.shape_spaces.gradient.faces import FaceGradients, padded
from tempose.shape_spaces.gradient.references import as_axes, as_rows, middle_rotations
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
    middle = middle_rotations(bodies[:, None], np.ones(1))[0]
    return padded(as_rows(middle @ polar_rotation(total)))
