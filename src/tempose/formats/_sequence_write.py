"""Clips to one file a frame: all of them or none."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path

import numpy as np

from tempose._files import atomic_path
from tempose.clips import Mesh, MeshClip
from tempose.formats._frames import split_counter
from tempose.formats._place import outside
from tempose.formats._sequence import still_module
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, Progress


def write_still(path: Path, mesh: Mesh, up: str, unit: float) -> None:
    """Write one mesh.

    Parameters
    ----------
    path : Path
        File to write; takes its name only when complete.
    mesh : Mesh
        Metres, Y up.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.
    """
    encode = still_module(path.suffix.lower()).encoder(mesh)
    with atomic_path(path) as part:
        part.write_bytes(encode(outside(mesh.vertices, up, unit)))


def write_sequence(path: str, clip: MeshClip, up: str, unit: float, progress: Progress) -> None:
    """Write a clip as one file a frame: all of them or none.

    Parameters
    ----------
    path : str
        A folder, for ``frame_0000.obj`` and on, or a pattern such as ``run.####.obj``.
    clip : MeshClip
        Metres, Y up.
    up : str
        Up axis of the files.
    unit : float
        Metres per unit of the files.
    progress : Progress
        Told about every frame.

    Raises
    ------
    FormatError
        If the folder holds other things than frames.
    """
    place = Path(path)
    counter = split_counter(place.name)
    if counter is None:
        _refuse_foreign(place)
        with atomic_path(place, folder=True) as part:
            _write_frames(part, ("frame_", 4, ".obj"), clip, up, unit, progress)
    elif not place.parent.exists():
        with atomic_path(place.parent, folder=True) as part:
            _write_frames(part, counter, clip, up, unit, progress)
    else:
        with tempfile.TemporaryDirectory(prefix=".frames.", suffix=".part", dir=place.parent) as scratch:
            _write_frames(Path(scratch), counter, clip, up, unit, progress)
            _replace_frames(Path(scratch), place.parent, counter)


def _write_frames(
    folder: Path, counter: tuple[str, int, str], clip: MeshClip, up: str, unit: float, progress: Progress
) -> None:
    before, width, after = counter
    encode = still_module(Path(f"x{after}").suffix.lower()).encoder(clip.mesh)
    for t, frame in enumerate(clip.vertices):
        progress(t, clip.n_frames, "writing frames")
        V: FloatArray = outside(frame, up, unit)
        # scaled positions need float64 to come back as the same float32; in text 9 digits do
        V = V.astype(np.float32) if unit == 1.0 else V
        (folder / f"{before}{t:0{width}d}{after}").write_bytes(encode(V, digits=9))
    progress(clip.n_frames, clip.n_frames, "writing frames")


def _replace_frames(scratch: Path, folder: Path, counter: tuple[str, int, str]) -> None:
    """Move finished frames to their place; those left from a longer clip of the same name go."""
    shape = re.compile(re.escape(counter[0]) + r"[0-9]+" + re.escape(counter[2]))
    written = {p.name for p in scratch.iterdir()}
    for old in [p for p in folder.iterdir() if shape.fullmatch(p.name) and p.name not in written]:
        old.unlink()
    for name in sorted(written):
        os.replace(scratch / name, folder / name)


def _refuse_foreign(folder: Path) -> None:
    """Keep whatever a user has in a folder that is about to be replaced."""
    if not folder.is_dir():
        return
    foreign = [p.name for p in folder.iterdir() if not re.fullmatch(r"frame_[0-9]+\.obj", p.name)]
    if foreign:
        raise FormatError(
            f"{folder}: expected a new folder, or one of frames written before, found {min(foreign)!r} "
            f"in it; write to another folder or to {folder.name}/frame_####.obj"
        )
