"""Pictures and films as files; what is half written never takes the final name."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.render.colors import Picture
from tempose.render.text import pillow
from tempose.typing import Progress, silent


def as_picture(picture: Any, name: str = "picture") -> Picture:
    """Check a picture.

    Parameters
    ----------
    picture : (height, width, 3) uint8
        sRGB.
    name : str, default "picture"
        Name of the argument, for the message.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        The same, contiguous.

    Raises
    ------
    ValueError
        If shape or type is another.
    """
    array = np.asarray(picture)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape or array.dtype != np.uint8:
        raise ValueError(f"{name} must be uint8 (height, width, 3), got {array.dtype} {array.shape}")
    return np.ascontiguousarray(array)


def save_png(picture: Any, path: str | os.PathLike[str]) -> None:
    """Write a picture as PNG.

    Parameters
    ----------
    picture : (height, width, 3) uint8
        sRGB.
    path : path-like
        File to write or replace.
    """
    image = pillow().Image.fromarray(as_picture(picture))
    with atomic_path(path) as part:
        image.save(part, format="PNG", optimize=True)


def save_gif(
    frames: Iterable[Any],
    path: str | os.PathLike[str],
    fps: float = 30.0,
    *,
    total: int = 0,
    progress: Progress = silent,
) -> None:
    """Write pictures as a GIF that loops for ever, with one palette for all.

    Parameters
    ----------
    frames : iterable of (height, width, 3) uint8
        sRGB pictures of one size.
    path : path-like
        File to write or replace.
    fps : float, default 30
        Frames per second. GIF counts hundredths of a second: delays alternate so that the speed is kept;
        viewers slow down above 50.
    total : int, default 0
        Number of frames if known, for `progress`.
    progress : Progress, default silent
        Called after each frame.

    Raises
    ------
    ValueError
        If there is no frame, or one has another size or type.
    """
    Image = pillow().Image
    checked = list(checked_frames(frames, total, progress))
    delays = gif_delays(len(checked), fps)
    step = max(len(checked) // 12, 1)
    # A palette of its own for every frame makes still surfaces flicker.
    palette = Image.fromarray(np.concatenate(checked[::step])).quantize(256, method=Image.Quantize.MEDIANCUT)
    images = [Image.fromarray(f).quantize(palette=palette, dither=Image.Dither.NONE) for f in checked]
    with atomic_path(path) as part:
        images[0].save(
            part, format="GIF", save_all=True, append_images=images[1:], duration=delays, loop=0, disposal=1
        )


def gif_delays(count: int, fps: float) -> list[int]:
    """Return whole hundredths of a second, as milliseconds, that keep the speed on average.

    Parameters
    ----------
    count : int
        Number of frames.
    fps : float
        Frames per second.

    Returns
    -------
    list of int
        A delay for each frame, at least 20 ms.

    Raises
    ------
    ValueError
        If `fps` is not positive.

    Examples
    --------
    >>> gif_delays(3, 30.0)
    [30, 40, 30]
    """
    if not 0 < fps < float("inf"):
        raise ValueError(f"fps must be positive, got {fps}")
    ends = np.round(np.arange(count + 1) * 100 / fps)
    return [int(max(10 * d, 20)) for d in np.diff(ends)]


def checked_frames(frames: Iterable[Any], total: int, progress: Progress) -> Iterable[Picture]:
    """Check pictures one by one as they come.

    Parameters
    ----------
    frames : iterable of (height, width, 3) uint8
        sRGB pictures.
    total : int
        Number of frames, for `progress`.
    progress : Progress
        Called after each.

    Yields
    ------
    (height, width, 3) ndarray of uint8
        The pictures.

    Raises
    ------
    ValueError
        If there is none, or one has another size or type.
    """
    shape = None
    for t, frame in enumerate(frames):
        picture = as_picture(frame, f"frames[{t}]")
        shape = shape or picture.shape
        if picture.shape != shape:
            raise ValueError(f"frames must have one size, got {picture.shape} at {t} after {shape}")
        yield picture
        progress(t + 1, total, "rendering")
    if shape is None:
        raise ValueError("frames must hold at least one picture, got none")
