"""Which files are the frames of a sequence: a folder, a glob, ``name.####.obj`` or ``name.%04d.obj``."""

from __future__ import annotations

import glob
import re
from dataclasses import dataclass
from pathlib import Path

from tempose.formats.conventions import FormatError

SEQUENCE_SUFFIXES = (".obj", ".ply", ".off")
"""File name endings of which many make a clip."""

_COUNTER = re.compile(r"#+|%0?\d*d")


@dataclass(frozen=True)
class Frames:
    """The files of a sequence, in the order they are played."""

    paths: tuple[Path, ...]
    """At least one file, all of one ending."""
    suffix: str
    """That ending, lower case, with its dot."""
    notes: tuple[str, ...] = ()
    """Gaps in the numbering."""


def natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Key that sorts frame names as people count: 2 before 10.

    Parameters
    ----------
    name : str
        File name.

    Returns
    -------
    tuple
        Comparable key.

    Examples
    --------
    >>> sorted(["10.obj", "2.obj"], key=natural_key)
    ['2.obj', '10.obj']
    """
    parts = re.split(r"([0-9]+)", name)
    return tuple((0, int(p), p) if p.isdigit() and p.isascii() else (1, 0, p) for p in parts)


def split_counter(name: str) -> tuple[str, int, str] | None:
    """Split a pattern at its frame counter.

    Parameters
    ----------
    name : str
        File name, perhaps with ``####`` or ``%04d`` in it.

    Returns
    -------
    tuple of (str, int, str) or None
        What stands before, digits, what stands after; None without a counter.

    Examples
    --------
    >>> split_counter("run.####.obj")
    ('run.', 4, '.obj')
    """
    found = list(_COUNTER.finditer(name))
    if not found:
        return None
    last = found[-1]
    text = last.group()
    width = len(text) if text[0] == "#" else int(text[1:-1] or 0)
    return name[: last.start()], width, name[last.end() :]


def find_frames(path: str) -> Frames | None:
    """Find the frames that a path stands for.

    Parameters
    ----------
    path : str
        Folder, glob or pattern.

    Returns
    -------
    Frames or None
        The files; None if the path is one plain file name.

    Raises
    ------
    FormatError
        If nothing is found or several kinds of mesh lie there.
    """
    place = Path(path)
    if place.is_file():
        return None
    if place.is_dir():
        files = [p for p in place.iterdir() if p.suffix.lower() in SEQUENCE_SUFFIXES]
        return _checked(path, files, "a folder")
    counter = split_counter(place.name)
    if counter is not None:
        before, _, after = counter
        shape = re.compile(re.escape(before) + r"[0-9]+" + re.escape(after))
        siblings = place.parent.iterdir() if place.parent.is_dir() else ()
        return _checked(path, [p for p in siblings if shape.fullmatch(p.name)], "a pattern")
    if glob.has_magic(path):
        # brackets in the names of folders that exist are no wildcards
        known = place.parent.is_dir()
        found = place.parent.glob(place.name) if known else map(Path, glob.glob(path))
        return _checked(path, list(found), "a glob")
    return None


def _checked(path: str, found: list[Path], kind: str) -> Frames:
    files = [p for p in found if not p.name.startswith(".") and p.is_file()]
    if not files:
        raise FormatError(
            f"{path}: expected {kind} of mesh frames ({', '.join(SEQUENCE_SUFFIXES)}), found none"
        )
    suffixes = sorted({p.suffix.lower() for p in files})
    if len(suffixes) > 1 or suffixes[0] not in SEQUENCE_SUFFIXES:
        raise FormatError(
            f"{path}: expected frames of one kind ({', '.join(SEQUENCE_SUFFIXES)}), "
            f"found {', '.join(suffixes)}; name them with a glob such as '{Path(path).name}/*.obj'"
        )
    files.sort(key=lambda p: (natural_key(p.stem), str(p)))
    return Frames(tuple(files), suffixes[0], _gaps(files))


def _gaps(files: list[Path]) -> tuple[str, ...]:
    """Note missing numbers when all names differ in one number only."""
    split = [re.fullmatch(r"(.*?)([0-9]+)([^0-9]*)", p.stem) for p in files]
    if len({(m[1], m[3]) for m in split if m}) != 1 or not all(split):
        return ()
    numbers = {int(m[2]) for m in split if m}
    missing = max(numbers) - min(numbers) + 1 - len(numbers)
    if missing <= 0:
        return ()
    return (f"{missing} of the frames {min(numbers)} to {max(numbers)} are missing",)
