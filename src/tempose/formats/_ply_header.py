"""Header of a PLY file: which elements follow, how many, with which properties.

Format: Greg Turk, "The PLY Polygon File Format", Stanford 1994.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats._input import excerpt
from tempose.formats.conventions import FormatError

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2",
    "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Property:
    """One value, or one list of values, of every row of an element."""

    name: str
    """Its name."""
    kind: str
    """Numpy type without byte order."""
    count_kind: str = ""
    """Numpy type of a list's length; empty for a single value."""


@dataclass(frozen=True)
class Element:
    """A table: vertices, faces or anything else."""

    name: str
    """Its name."""
    count: int
    """Rows as stated; not to be trusted."""
    properties: tuple[Property, ...]
    """Columns, in order."""


@dataclass(frozen=True)
class Header:
    """All that stands before the body."""

    order: str
    """``"<"``, ``">"`` or empty for text."""
    elements: tuple[Element, ...]
    """Tables, in order."""
    comments: tuple[str, ...]
    """Comment lines, without their keyword."""
    body: int
    """Byte at which the body begins."""
    lines: int
    """Lines of the header."""


def read_header(path: str, data: bytes) -> Header:
    """Read the header.

    Parameters
    ----------
    path : str
        File to name in messages.
    data : bytes
        The whole file.

    Returns
    -------
    Header
        Names, types and counts.

    Raises
    ------
    FormatError
        If it is none; the message names the line.
    """
    end = data.find(b"end_header")
    newline = data.find(b"\n", end)
    if not data.startswith(b"ply") or end < 0 or newline < 0:
        raise FormatError(
            f"{path}: expected a PLY header from 'ply' to 'end_header', found {excerpt(data[:40])}"
        )
    lines = data[:newline].decode("utf-8", "replace").splitlines()
    order: str | None = None
    elements: list[Element] = []
    comments: list[str] = []
    for number, line in enumerate(lines[1:-1], start=2):
        words = line.split()
        try:
            if not words or words[0] in ("comment", "obj_info"):
                comments.append(line.partition(" ")[2])
            elif words[0] == "format":
                order = _ENCODINGS[words[1]]
            elif words[0] == "element":
                elements.append(Element(words[1], _count(words[2]), ()))
            elif words[0] == "property":
                last = elements.pop()
                elements.append(Element(last.name, last.count, (*last.properties, _property(words))))
            else:
                raise KeyError(words[0])
        except (KeyError, IndexError, ValueError):
            raise FormatError(
                f"{path}, line {number}: expected format, element, property or comment of a PLY header, "
                f"found {excerpt(line.encode())}"
            ) from None
    if order is None:
        raise FormatError(f"{path}: expected a 'format' line in the PLY header, found none")
    return Header(order, tuple(elements), tuple(comments), newline + 1, len(lines))


def _count(word: str) -> int:
    if not word.isascii() or not word.isdigit() or len(word) > 18:
        raise ValueError(word)
    return int(word)


def _property(words: list[str]) -> Property:
    if words[1] != "list":
        return Property(words[2], _TYPES[words[1]])
    if np.dtype(_TYPES[words[2]]).kind == "f":
        raise ValueError("a length must be an integer")
    return Property(words[4], _TYPES[words[3]], _TYPES[words[2]])
