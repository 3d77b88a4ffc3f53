"""Splitting a clip into where the body is and what shape it has."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.clips.blocks import read_block
from tempose.rotations import from_matrix, polar_rotation
from tempose.signals.blocks import block_slices
from tempose.signals.placement.place import in_body
from tempose.signals.placement.spline import continuous_signs
from tempose.typing import FloatArray, Progress, silent


def split_placement(
    V: FloatArray, reference: FloatArray | None = None, rounds: int = 2
) -> tuple[FloatArray, FloatArray]:
    """Split a clip that fits into memory into placements and shapes.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames, metres.
    reference : (n, 3) float, optional
        The shape whose rotation counts as none; the first frame by default.
    rounds : int, default 2
        See `fit_placements`.

    Returns
    -------
    placements : (T, 7) ndarray
        Rotations wxyz from the body to the world, with continuous signs, and centroids in metres.
    bodies : (T, n, 3) ndarray
        The frames about their centroids, turned back: ``place(bodies, placements)`` is `V`.
    """
    placements = fit_placements(V, reference, rounds)
    return placements, in_body(V, placements)


def fit_placements(
    V: FloatArray, reference: FloatArray | None = None, rounds: int = 2, progress: Progress = silent
) -> FloatArray:
    """Find where the body is in each frame, reading a memory map block by block.

    The centroid of the vertices, and the rotation that brings the reference shape nearest to the frame. From
    the second round on the reference is the mean shape of the round before, which leaves the least to
    the shape signal.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames, metres; an array or a memory map.
    reference : (n, 3) float, optional
        The shape whose rotation counts as none; the first frame by default.
    rounds : int, default 2
        How often the clip is read; 1 aligns to `reference` itself.
    progress : Progress, optional
        Told how many frames each round has read.

    Returns
    -------
    (T, 7) ndarray
        Rotations wxyz from the body to the world, with continuous signs, and centroids in metres.

    Raises
    ------
    ValueError
        If shapes differ, a value is NaN, or there is no round.
    """
    if rounds < 1:
        raise ValueError(f"rounds must be at least 1, got {rounds}")
    T, n, _ = V.shape
    shape = as_floats(V[0] if reference is None else reference, "reference", (n, 3))
    placements = np.zeros((T, 7))
    for i in range(rounds):
        P = shape - shape.mean(axis=0)
        total = np.zeros_like(P)
        for frames in block_slices(T, 3 * n):
            Q = read_block(V, frames)
            placements[frames] = _placements(P, Q)
            if i + 1 < rounds:
                total += in_body(Q, placements[frames]).sum(axis=0)
            progress(frames.stop, T, f"placement, round {i + 1} of {rounds}")
        shape = total / T  # not turned against the shape before: no frame was, once aligned to it
    return continuous_signs(placements)


def _placements(P: FloatArray, Q: FloatArray) -> FloatArray:
    # the sum of P is zero, so that of Q may be anything: it need not be centred first
    R = polar_rotation(np.swapaxes(Q, -1, -2) @ P)
    return np.concatenate([from_matrix(R), Q.mean(axis=-2)], axis=-1)
