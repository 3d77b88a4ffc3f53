"""Faces of an OBJ text: corners in every notation, polygons, groups.

A face line is ``f`` and three or more corners ``v``, ``v/vt``, ``v//vn`` or ``v/vt/vn``; indices count
from 1, negative ones backwards from the last vertex above the line (Wavefront, "Advanced Visualizer"
manual, appendix B1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats._input import excerpt
from tempose.formats._numbers import Lines, NumberError, parse_ints, tokens_per_line
from tempose.formats.conventions import FormatError
from tempose.typing import BoolArray, IntArray


@dataclass(frozen=True)
class Corners:
    """Corners of all polygons of a file, in order."""

    counts: IntArray
    """(p,) corners per polygon."""
    vertex: IntArray
    """(c,) vertex per corner, 0-based."""
    uv: IntArray | None
    """(c,) texture vertex per corner, -1 where a corner has none; None if no corner has one."""


def read_corners(
    path: str, lines: Lines, is_face: BoolArray, block: bytes, is_vertex: BoolArray, is_uv: BoolArray
) -> Corners:
    """Read the corners of all faces.

    Parameters
    ----------
    path : str
        File to name in messages.
    lines : Lines
        The whole text.
    is_face, is_vertex, is_uv : (l,) bool
        Which lines are ``f``, ``v``, ``vt``.
    block : bytes
        The face lines without their keyword.

    Returns
    -------
    Corners
        Checked indices.

    Raises
    ------
    FormatError
        If a corner is no index, an index is out of range or a face has fewer than three corners.
    """
    rows = np.flatnonzero(is_face)
    counts = tokens_per_line(block)
    if (counts < 3).any():
        row = rows[int(np.argmax(counts < 3))]
        raise FormatError(f"{_place(path, lines, row)}: expected a face of 3 or more corners")
    fields = _uniform_fields(block, int(counts.sum()))
    if fields is None:
        fields = _mixed_fields(path, lines, rows, block)
    row_of_corner = np.repeat(rows, counts)
    vertex = _resolve(path, lines, fields[:, 0], row_of_corner, is_vertex, "vertex")
    uv = None
    if (fields[:, 1] != 0).any():
        uv = _resolve(path, lines, fields[:, 1], row_of_corner, is_uv, "texture vertex", optional=True)
    return Corners(counts, vertex, uv)


def _uniform_fields(block: bytes, n_corners: int) -> IntArray | None:
    """(c, 2) vertex and uv fields as written, 0 for none; None unless all corners look the same."""
    slashes = block.count(b"/")
    doubles = block.count(b"//")
    per_corner, rest = divmod(slashes, n_corners)
    if rest or per_corner > 2 or doubles not in (0, n_corners) or (doubles and per_corner != 2):
        return None
    width = 1 if doubles else per_corner + 1
    if slashes and not _slashes_alike(block, per_corner):
        return None
    try:
        numbers = parse_ints(block.replace(b"/", b" ") if slashes else block)
    except NumberError:
        return None
    width = 2 if doubles else width
    if len(numbers) != n_corners * width:
        return None
    table = numbers.reshape(n_corners, width)
    if (table == 0).any():
        return None
    fields = np.zeros((n_corners, 2), np.int64)
    fields[:, 0] = table[:, 0]
    if width > 1 and not doubles:
        fields[:, 1] = table[:, 1]
    return fields


def _slashes_alike(block: bytes, per_corner: int) -> bool:
    text = np.frombuffer(block, np.uint8)
    ink = text > 32
    ends = ink.copy()
    ends[:-1] &= ~ink[1:]
    seen = np.cumsum(text == ord("/"))[ends]
    return bool((np.diff(seen, prepend=0) == per_corner).all())


def _mixed_fields(path: str, lines: Lines, rows: IntArray, block: bytes) -> IntArray:
    """(c, 2) fields of faces whose corners differ in notation: slower, names the line that is wrong."""
    fields: list[tuple[int, int]] = []
    for row, text in zip(rows, block.split(b"\n")):
        for corner in text.split():
            parts = corner.split(b"/")
            try:
                vertex = int(parts[0])
                uv = int(parts[1]) if len(parts) > 1 and parts[1] else 0
                [int(part) for part in parts[2:] if part]
                good = len(parts) <= 3 and vertex != 0 and abs(vertex) < 2**31 and abs(uv) < 2**31
            except ValueError:
                good, vertex, uv = False, 0, 0
            if not good:
                raise FormatError(
                    f"{_place(path, lines, row)}: expected corners such as 1, 1/2, 1//3 or 1/2/3, "
                    f"counted from 1, found {excerpt(corner)}"
                )
            fields.append((vertex, uv))
    return np.array(fields, dtype=np.int64).reshape(-1, 2)


def _resolve(
    path: str,
    lines: Lines,
    index: IntArray,
    row: IntArray,
    counted: BoolArray,
    what: str,
    optional: bool = False,
) -> IntArray:
    """0-based indices; negative ones count back from the last one above their line; -1 for none."""
    total = int(counted.sum())
    result = index - 1
    negative = index < 0
    if negative.any():
        above = np.cumsum(counted)[row[negative]]
        result[negative] = above + index[negative]
    bad = (result < 0) | (result >= total)
    if optional:
        bad &= index != 0
    if bad.any():
        corner = int(np.argmax(bad))
        raise FormatError(
            f"{_place(path, lines, row[corner])}: refers to {what} {index[corner]}, the file has {total}"
        )
    return result


def _place(path: str, lines: Lines, row: int) -> str:
    return f"{path}, line {int(row) + 1}"


def read_groups(lines: Lines, is_face: BoolArray, keyword: bytes) -> dict[str, IntArray]:
    """Collect which faces stand under which group lines.

    Parameters
    ----------
    lines : Lines
        The whole text.
    is_face : (l,) bool
        Which lines are faces.
    keyword : bytes
        ``b"g"``, ``b"o"`` or ``b"usemtl"``.

    Returns
    -------
    dict of str to ndarray of int
        Name to polygon indices, empty groups left out. ``g`` may name several groups at once, and none
        to end the last; the others take the rest of the line as one name.
    """
    rows = keyword_rows(lines, keyword)
    if len(rows) == 0:
        return {}
    faces_above = np.cumsum(is_face)
    begins = faces_above[rows].tolist()
    ends = [*begins[1:], int(faces_above[-1])]
    members: dict[str, list[IntArray]] = {}
    for row, begin, end in zip(rows, begins, ends):
        if end > begin:
            rest = lines.line(int(row))[len(keyword) :].decode("utf-8", "replace").split("#")[0]
            for name in dict.fromkeys(rest.split() if keyword == b"g" else [rest.strip()]):
                if name:
                    members.setdefault(name, []).append(np.arange(begin, end))
    return {name: np.concatenate(parts) for name, parts in members.items()}


def keyword_rows(lines: Lines, keyword: bytes) -> IntArray:
    """Find the lines that begin with a keyword.

    Parameters
    ----------
    lines : Lines
        The whole text.
    keyword : bytes
        The keyword, at least one letter.

    Returns
    -------
    (k,) ndarray of int
        0-based lines.
    """
    if len(keyword) == 1:
        second = lines.keys % 256
        return np.flatnonzero((lines.keys // 256 == keyword[0]) & (second <= 32))
    rows = np.flatnonzero(lines.keys == keyword[0] * 256 + keyword[1])
    return np.array([r for r in rows if lines.line(int(r)).split()[:1] == [keyword]], dtype=np.int64)
