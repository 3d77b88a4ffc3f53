"""Writing that never leaves half a file under the final name."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic_path(path: str | os.PathLike[str], *, folder: bool = False) -> Generator[Path, None, None]:
    """Give a temporary neighbour to write to; it takes the final name only if the block succeeds.

    Parameters
    ----------
    path : path-like
        Final name; its parent must exist.
    folder : bool, default False
        Whether the result is a folder; an existing folder of that name is replaced.

    Yields
    ------
    Path
        Where to write. For a file it keeps the suffix; for a folder it exists and is empty.

    Raises
    ------
    OSError
        If the place cannot be written; the message names it.
    """
    final = Path(path)
    if not final.parent.is_dir():
        raise FileNotFoundError(f"{final.parent}: no such folder to write {final.name!r} in; create it first")
    scratch = Path(tempfile.mkdtemp(prefix=f".{final.name}.", suffix=".part", dir=final.parent))
    part = scratch / final.name
    try:
        if folder:
            part.mkdir()
        yield part
        if folder and final.is_dir():
            _replace_folder(part, final, scratch / "replaced")
        else:
            os.replace(part, final)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _replace_folder(part: Path, final: Path, aside: Path) -> None:
    """Swap folders, which no single call does; if the second step fails, undo the first."""
    os.replace(final, aside)
    try:
        os.replace(part, final)
    except BaseException:
        os.replace(aside, final)
        raise
