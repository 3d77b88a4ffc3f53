"""Frames of a long clip stay on disk between being made and being written, so that memory is bounded."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tempose.typing import Progress

if TYPE_CHECKING:
    from tempose.clips import MeshClip

IN_MEMORY = 256 << 20
"""Bytes of float32 frames above which they go to a file beside the output."""


@contextmanager
def room_for_frames(n_frames: int, n_vertices: int, out: Path) -> Generator[Path | None, None, None]:
    """Give a folder for frames that are many; it is gone when the block ends, however it ends.

    Parameters
    ----------
    n_frames, n_vertices : int
        Size of the clip that will be made.
    out : Path
        Where the result goes: the same disk must hold it anyway.

    Yields
    ------
    Path or None
        The folder; None for a clip that memory can hold.

    Raises
    ------
    ValueError
        If the disk has no room for them.
    """
    if 12 * n_frames * n_vertices <= IN_MEMORY:
        yield None
        return
    free = shutil.disk_usage(out.parent).free
    wanted = 24 * n_frames * n_vertices  # once while they are made and once in the output
    if wanted > free:
        raise ValueError(
            f"{out}: {n_frames} frames of {n_vertices} vertices need {wanted / 1e9:.3g} GB of disk, "
            f"{free / 1e9:.3g} GB are free; ask for fewer frames, or write elsewhere"
        )
    prefix = f".{out.name}."
    with tempfile.TemporaryDirectory(prefix=prefix, suffix=".part", dir=out.parent) as folder:
        yield Path(folder)


def releasing(progress: Progress, clip: MeshClip) -> Progress:
    """Forget the frames of a clip on disk as they are done with.

    Parameters
    ----------
    progress : Progress
        What is told about every frame.
    clip : MeshClip
        Whose frames may be a memory map.

    Returns
    -------
    Progress
        The same, and memory is given back on the way.
    """
    from tempose.transfer.frames import release

    def tell(done: int, total: int, stage: str) -> None:
        release(clip.vertices)
        progress(done, total, stage)

    return tell
