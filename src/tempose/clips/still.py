"""Clips in which nothing moves."""

from __future__ import annotations

import numpy as np

from tempose.clips.blocks import cut_blocks, read_block
from tempose.clips.mesh_clip import MeshClip

_BLOCK = 1_000_000


def stands_still(clip: MeshClip, share: float = 1e-6) -> bool:
    """Say whether all frames of a clip are the same.

    Parameters
    ----------
    clip : MeshClip
        At least one frame.
    share : float, default 1e-6
        What vertices may move by, in diagonals of the rest mesh.

    Returns
    -------
    bool
        True also of a clip of one frame.
    """
    first = np.asarray(clip.vertices[0], dtype=np.float64)
    least = share * max(clip.mesh.diagonal, 1e-300)
    return all(
        np.abs(read_block(clip.vertices, some) - first).max(initial=0.0) <= least
        for some in cut_blocks(clip.n_frames, first.size, _BLOCK)
    )
