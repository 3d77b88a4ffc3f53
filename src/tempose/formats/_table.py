"""What is known about every kind of file, and the checks that come before any of them is opened."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tempose.formats._place import check_up, metres_per_unit
from tempose.formats.conventions import FormatError

PathLike = str | os.PathLike[str]
Unit = str | float | None


@dataclass(frozen=True)
class Format:
    """One row of the table."""

    reads: tuple[str, ...]
    """What it can hold: ``"mesh"``, ``"clip"``, ``"skeleton"``, ``"skin"``."""
    writes: bool
    """Whether `save` can write it."""


FORMATS: dict[str, Format] = {
    ".obj": Format(("mesh", "clip"), True),
    ".ply": Format(("mesh", "clip"), True),
    ".off": Format(("mesh", "clip"), True),
    ".npz": Format(("mesh", "clip"), True),
    ".npy": Format(("clip",), True),
    ".glb": Format(("mesh", "clip", "skeleton", "skin"), True),
    ".gltf": Format(("mesh", "clip", "skeleton", "skin"), False),
    ".usda": Format(("mesh", "clip", "skeleton", "skin"), True),
    ".usdc": Format(("mesh", "clip", "skeleton", "skin"), True),
    ".usd": Format(("mesh", "clip", "skeleton", "skin"), True),
    ".bvh": Format(("skeleton",), True),
    ".amc": Format(("skeleton",), False),
    ".mhw": Format(("skin",), False),
}
"""File name ending to what is known about it; modules are imported only when needed."""


GLTF_SUFFIXES = (".glb", ".gltf")
"""The two containers of glTF 2.0."""

USD_SUFFIXES = (".usda", ".usdc", ".usd")
"""Text, binary, and either of them."""


def known_suffix(place: str) -> str:
    """Check that a file exists and is of a kind that some reader knows.

    Parameters
    ----------
    place : str
        The file.

    Returns
    -------
    str
        Its ending, lower case, with the dot.

    Raises
    ------
    FormatError
        If it does not exist or its kind is unknown.
    """
    path = Path(place)
    suffix = path.suffix.lower()
    if not path.exists():
        raise FormatError(f"{place}: no such file")
    if suffix == ".asf":
        raise FormatError(f"{place}: holds a skeleton without motion; give the .amc file beside it")
    if suffix not in FORMATS:
        known = ", ".join(FORMATS)
        raise FormatError(f"{place}: unknown kind of file {suffix or '(no ending)'!r}; known are {known}")
    return suffix


def check_arguments(up: str | None, unit: Unit, fps: float | None) -> None:
    """Refuse what no file can be overruled with.

    Parameters
    ----------
    up, unit, fps : see `tempose.formats.load`
        What the user states.

    Raises
    ------
    ValueError
        If one of them is impossible.
    """
    check_up(up)
    metres_per_unit(unit)
    if fps is not None and not 0 < fps < float("inf"):
        raise ValueError(f"fps must be positive, got {fps}")
