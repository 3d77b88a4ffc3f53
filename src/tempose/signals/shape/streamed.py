"""The shape signal of a clip that is read in passes over its file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tempose.linalg.streamed_pca import StreamedPca, streamed_pca
from tempose.shape_spaces import ShapeSpace, VertexSpace, shape_space
from tempose.signals.fit.frames import FOLLOWING, ClipFrames
from tempose.signals.shape.fit import FittedShape, checked_frames
from tempose.signals.shape.signal import ShapeSignal
from tempose.typing import FloatArray, IntArray, Progress, silent

SEEN = 200
"""Frames shown to a space that suits itself to a clip."""

_BACK = 16

WIDTH = 64
"""Components of the first sketch where only decoded frames tell how many are needed."""


def streamed_space(name: str, frames: ClipFrames) -> ShapeSpace:
    """Make the shape space of a long clip.

    Parameters
    ----------
    name : str
        One of `FOLLOWING`.
    frames : ClipFrames
        The clip.

    Returns
    -------
    ShapeSpace
        Suited to frames spread over the clip.

    Raises
    ------
    ValueError
        If coordinates of that space cannot be found block by block.
    """
    clip = frames.clip
    if name not in FOLLOWING:
        raise ValueError(
            f"a clip of {clip.n_frames} frames of {len(clip.rest)} vertices is too large for the space "
            f"{name!r}; choose {', '.join(FOLLOWING[:-1])} or {FOLLOWING[-1]}, or fewer frames"
        )
    if name == VertexSpace.name:
        return VertexSpace(len(clip.rest))
    return shape_space(name, clip.rest, clip.faces, frames.block(_seen(frames)))


def _seen(frames: ClipFrames) -> IntArray:
    T = frames.clip.n_frames
    return np.unique(np.linspace(0, T - 1, min(SEEN, T)).round().astype(np.int64))


def fit_streamed_shape(
    space: ShapeSpace, frames: ClipFrames, m: int | None, limit: float, progress: Progress = silent
) -> FittedShape:
    """Find the principal components of a long clip.

    Parameters
    ----------
    space : ShapeSpace
        As `streamed_space` makes it.
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
    if not isinstance(space, VertexSpace):
        return _fit_decoded(space, frames, m, limit, progress)
    tolerance = limit / (unit * np.sqrt(T)) if m is None else None
    found = streamed_pca(frames.blocks, space.dimension, m, tolerance=tolerance, progress=progress)
    return _fitted(space, found, len(found.components), unit)


def first_coordinates(space: ShapeSpace, frames: ClipFrames) -> FloatArray:
    """Encode the first frame so that the clip goes on from it through the frame nearest to the reference.

    There rotations are least and no turn is in doubt; from there the clip is followed back to its start.

    Parameters
    ----------
    space : ShapeSpace
        As `streamed_space` makes it.
    frames : ClipFrames
        The clip.

    Returns
    -------
    (d,) ndarray
        Coordinates.
    """
    following: Any = space
    seen = _seen(frames)
    sizes = [float(np.linalg.norm(space.encode(frames.block(seen[i : i + 1])))) for i in range(len(seen))]
    nearest = int(seen[int(np.argmin(sizes))])
    z = space.encode(frames.block(slice(nearest, nearest + 1)))[0]
    for stop in range(nearest, 0, -_BACK):
        back = frames.block(slice(max(stop - _BACK, 0), stop))[::-1]
        z = following.encode_path(back, z)[-1].copy()
    return z


def encoded_blocks(space: ShapeSpace, frames: ClipFrames, first: FloatArray) -> Iterator[FloatArray]:
    """Encode a clip block by block, as if all at once.

    Parameters
    ----------
    space : ShapeSpace
        As `streamed_space` makes it.
    frames : ClipFrames
        The clip.
    first : (d,) float
        Coordinates of the first frame, from which the others go on.

    Yields
    ------
    (k, d) ndarray
        Coordinates of some frames.
    """
    following: Any = space
    last = first
    for block in frames.blocks(space.dimension // 3):
        z = following.encode_path(block.reshape(len(block), -1, 3), last)
        last = z[-1].copy()
        yield z


def _fit_decoded(
    space: ShapeSpace, frames: ClipFrames, m: int | None, limit: float, progress: Progress
) -> FittedShape:
    """Take the components with which some decoded frames meet the limit; wider sketches until they do."""
    which, width = checked_frames(frames.clip.n_frames), m or WIDTH
    V, first = frames.block(which), first_coordinates(space, frames)

    def blocks() -> Iterator[FloatArray]:
        return encoded_blocks(space, frames, first)

    def percent(found: StreamedPca, count: int) -> float:
        z = found.mean + found.coordinates[which, :count] @ found.components[:count]
        off = np.square(space.decode(z) - V).sum() / max(V.size // 3, 1)
        return 100.0 / frames.diagonal * float(np.sqrt(off))

    while True:
        found = streamed_pca(blocks, space.dimension, width, progress=progress)
        count = len(found.components)
        if m is not None or count < width or percent(found, count) <= limit:
            break
        width *= 2
    low, high = (-1, count) if m is None else (min(m, count) - 1, min(m, count))
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if percent(found, middle) <= limit else (middle, high)
    fitted = _fitted(space, found, high, 0.0)
    outside = float(fitted.left_out[which].mean() * frames.clip.n_frames)
    scale = percent(found, high) / np.sqrt(outside) if outside > 0 else 0.0
    return _fitted(space, found, high, scale)


def _fitted(space: ShapeSpace, found: StreamedPca, m: int, scale: float) -> FittedShape:
    X, H = found.coordinates, found.components
    left_out = found.left_out + np.square(X[:, m:]).sum(axis=1)
    shape = ShapeSignal(space, found.mean, np.ascontiguousarray(H[:m]))
    return FittedShape(shape, np.ascontiguousarray(X[:, :m]), None, left_out, found.spectrum, scale)
