"""Films as MP4, by the ffmpeg that comes with imageio-ffmpeg."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.render.writers import checked_frames
from tempose.typing import Progress, silent

# Say which matrix was used, or players guess by the size of the picture and shift the colours.
_COLOUR = (
    "-vf scale=out_color_matrix=bt709:out_range=tv -colorspace bt709 -color_primaries bt709 "
    "-color_trc bt709 -color_range tv"
).split()


def save_mp4(
    frames: Iterable[Any],
    path: str | os.PathLike[str],
    fps: float = 30.0,
    *,
    crf: int = 18,
    total: int = 0,
    progress: Progress = silent,
) -> None:
    """Write pictures as H.264 that plays everywhere (yuv420p, even sizes: an odd edge is repeated).

    Parameters
    ----------
    frames : iterable of (height, width, 3) uint8
        sRGB pictures of one size; taken one by one, so that a long film needs little memory.
    path : path-like
        File to write or replace.
    fps : float, default 30
        Frames per second.
    crf : int, default 18
        Quality, 0 (lossless) to 51; smaller is better and larger.
    total : int, default 0
        Number of frames if known, for `progress`.
    progress : Progress, default silent
        Called after each frame.

    Raises
    ------
    ValueError
        If there is no frame, or one has another size or type.
    OSError
        If the file cannot be written whole.
    """
    if not 0 < fps < float("inf"):
        raise ValueError(f"fps must be positive, got {fps}")
    ffmpeg = _ffmpeg()
    with atomic_path(path) as part:
        stream = None
        try:
            for picture in checked_frames(frames, total, progress):
                even = np.pad(picture, [(0, s % 2) for s in picture.shape[:2]] + [(0, 0)], mode="edge")
                if stream is None:
                    stream = ffmpeg.write_frames(
                        str(part),
                        (even.shape[1], even.shape[0]),
                        fps=fps,
                        codec="libx264",
                        pix_fmt_in="rgb24",
                        pix_fmt_out="yuv420p",
                        macro_block_size=2,
                        quality=None,
                        ffmpeg_log_level="error",
                        output_params=[*_COLOUR, "-crf", str(crf), "-movflags", "+faststart"],
                    )
                    stream.send(None)
                stream.send(even.tobytes())
        finally:
            if stream is not None:
                stream.close()
        _check_whole(ffmpeg, part, path)


def _check_whole(ffmpeg: Any, part: Path, path: str | os.PathLike[str]) -> None:
    # ffmpeg may end without a word when the disk is full: only reading the film back tells
    line = [ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(part), "-c", "copy", "-f", "null", "-"]
    read = subprocess.run(line, stdin=subprocess.DEVNULL, capture_output=True)
    if read.returncode or read.stderr:
        raise OSError(f"{path}: the film could not be written whole: is the disk full?")


def _ffmpeg() -> Any:
    try:
        import imageio_ffmpeg
    except ImportError:
        raise ImportError(
            'films need imageio-ffmpeg; install it with: pip install "tempose[render]"'
        ) from None
    return imageio_ffmpeg
