"""Clips from and to one file a frame."""

from __future__ import annotations

import os
import re
import tempfile
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.clips import Mesh, MeshClip
from tempose.formats._frames import Frames, split_counter
from tempose.formats._place import DEFAULT_FPS, inside, outside, settle
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, Progress


def still_module(suffix: str) -> Any:
    """Import the module that reads and writes one frame.

    Parameters
    ----------
    suffix : str
        ``".obj"``, ``".ply"`` or ``".off"``.

    Returns
    -------
    module
        Has ``read_first(path)``, ``read_next(path, first)`` and ``encoder(mesh)``.
    """
    return import_module(f"tempose.formats.{suffix[1:]}")


def read_still(path: str, suffix: str, up: str | None, unit: str | float | None) -> Mesh:
    """Read one mesh.

    Parameters
    ----------
    path : str
        File to read.
    suffix : str
        Its kind.
    up, unit : see `tempose.formats.load`
        What the user states.

    Returns
    -------
    Mesh
        Metres, Y up.

    Raises
    ------
    FormatError
        If it cannot be read.
    """
    first = _guarded(path, still_module(suffix).read_first, path)
    return settle(first.mesh, path, suffix[1:], up, unit, first.notes)


def read_sequence(
    frames: Frames,
    path: str,
    up: str | None,
    unit: str | float | None,
    fps: float | None,
    progress: Progress,
) -> MeshClip:
    """Read all frames of a clip; the first one is its rest pose.

    Parameters
    ----------
    frames : Frames
        The files.
    path : str
        What the user called them.
    up, unit, fps : see `tempose.formats.load`
        What the user states.
    progress : Progress
        Told about every frame.

    Returns
    -------
    MeshClip
        Metres, Y up.

    Raises
    ------
    FormatError
        If a frame cannot be read or differs in connectivity from the first.
    """
    module, names = still_module(frames.suffix), [str(p) for p in frames.paths]
    progress(0, len(names), "reading frames")
    first = _guarded(names[0], module.read_first, names[0])
    mesh = settle(first.mesh, path, frames.suffix[1:], up, unit, first.notes + frames.notes)
    if mesh.name == frames.paths[0].stem:
        mesh = replace(mesh, name=clip_name(path))
    vertices = np.zeros((len(names), *mesh.vertices.shape), np.float32)
    vertices[0] = mesh.vertices
    for t, name in enumerate(names[1:], start=1):
        progress(t, len(names), "reading frames")
        vertices[t] = inside(_guarded(name, module.read_next, name, first), mesh.source, name)
    progress(len(names), len(names), "reading frames")
    source = mesh.source if fps else replace(mesh.source, guessed=(*mesh.source.guessed, "fps"))
    return MeshClip(vertices, mesh, fps or DEFAULT_FPS, source)


def clip_name(path: str) -> str:
    """Name a clip after its folder or pattern.

    Parameters
    ----------
    path : str
        Folder, glob or pattern.

    Returns
    -------
    str
        A name without counter and wildcards.

    Examples
    --------
    >>> clip_name("data/run.####.obj"), clip_name("data/horse/"), clip_name("data/horse/*.obj")
    ('run', 'horse', 'horse')
    """
    place = Path(path)
    name = place.stem if place.suffix.lower() in (".obj", ".ply", ".off") else place.name
    counter = split_counter(name)
    name = (counter[0] if counter else name).split("*")[0].split("?")[0].split("[")[0].rstrip("._- ")
    return name or place.resolve().parent.name


def _guarded(path: str, function: Any, *arguments: Any) -> Any:
    """Call a reader; what the data types refuse is the fault of the file."""
    try:
        return function(*arguments)
    except FormatError:
        raise
    except MemoryError:
        raise FormatError(f"{path}: does not fit into memory") from None
    except ValueError as error:
        raise FormatError(f"{path}: {error}") from None


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
