"""The shape signal of a clip that is read in passes over its file."""

from __future__ import annotations

import numpy as np

from tempose.linalg.streamed_pca import streamed_pca
from tempose.shape_spaces import VertexSpace
from tempose.signals.frames import ClipFrames
from tempose.signals.shape.fit import FittedShape
from tempose.signals.shape.signal import ShapeSignal
from tempose.typing import Progress, silent


def fit_streamed_shape(
    space: VertexSpace,
    frames: ClipFrames,
    m: int | None,
    limit: float,
    progress: Progress = silent,
) -> FittedShape:
    """Find the principal components of a long clip.

    Parameters
    ----------
    space : VertexSpace
        Vertex coordinates: rotations of other spaces would have to be followed from frame to frame.
    frames : ClipFrames
        The clip.
    m : int or None
        Number of components; None takes the smallest that meets `limit`.
    limit : float
        Largest error, rms percent of the diagonal.
    progress : Progress, optional
        Told how many frames each pass has read.

    Returns
    -------
    FittedShape
        h and the coordinates; the spectrum ends with the directions looked at.
    """
    unit, T = frames.percent, frames.clip.n_frames
    # a clip that does not move at all has a limit of 0
    tolerance = max(limit / (unit * np.sqrt(T)), 1e-14 * frames.diagonal) if m is None else None
    found = streamed_pca(frames.blocks, space.dimension, m, tolerance=tolerance, progress=progress)
    shape = ShapeSignal(space, found.mean, found.components)
    return FittedShape(shape, found.coordinates, None, found.left_out, found.spectrum, unit)
