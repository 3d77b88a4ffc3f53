"""Clips from one file a frame."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.formats._frames import Frames, split_counter
from tempose.formats._numbers import use_kernel_for
from tempose.formats._place import DEFAULT_FPS, inside, settle
from tempose.formats.conventions import FormatError
from tempose.typing import Progress


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
    use_kernel_for(sum(p.stat().st_size for p in frames.paths))
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
        with np.errstate(all="ignore"):
            return function(*arguments)
    except FormatError:
        raise
    except MemoryError:
        raise FormatError(f"{path}: does not fit into memory") from None
    except ValueError as error:
        raise FormatError(f"{path}: {error}") from None
