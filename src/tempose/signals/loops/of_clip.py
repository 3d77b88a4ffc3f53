"""What loops are looked for in: the shape of a clip in each frame, without where the body is."""

from __future__ import annotations

import numpy as np

from tempose.clips import MeshClip
from tempose.linalg.pca import gram_pca
from tempose.signals.fit.frames import ClipFrames
from tempose.typing import FloatArray, Progress, silent


def travels(clip: MeshClip) -> bool:
    """Tell whether the body goes somewhere.

    Parameters
    ----------
    clip : MeshClip
        A clip.

    Returns
    -------
    bool
        Whether its middle moves by more than half of its size.
    """
    middle = np.stack([v.mean(axis=0, dtype=np.float64) for v in clip.vertices])
    size = float(np.linalg.norm(np.ptp(clip.rest, axis=0)))
    return bool(np.linalg.norm(np.ptp(middle, axis=0)) > 0.5 * size)


def clip_coordinates(clip: MeshClip, placement: bool = False, progress: Progress = silent) -> FloatArray:
    """Return coordinates of the frames whose distances are those of the frames.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    placement : bool, default False
        Whether where the body is and which way it turns shall not count.
    progress : Progress, default silent
        Told how many frames have been placed.

    Returns
    -------
    (T, m) ndarray
        For `find_loops` and `find_period`.

    Raises
    ------
    ValueError
        If the clip has fewer than 2 frames, or is too large to be looked at without a fitted model.
    """
    if clip.n_frames < 2:
        raise ValueError(f"a loop needs 2 frames or more, got {clip.n_frames}")
    frames = ClipFrames.of(clip, placement, progress)
    if frames.long:
        raise ValueError(
            f"the clip is too large, {clip.n_frames} frames of {len(clip.rest)} vertices; "
            "fit a model first and look for the loops of that"
        )
    return gram_pca(frames.block(slice(0, clip.n_frames)).reshape(clip.n_frames, -1)).coordinates
