"""Wavefront OBJ: vertices, polygons, texture coordinates, colours and groups; no materials, no normals."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tempose.clips import Mesh
from tempose.formats._input import excerpt, read_bytes
from tempose.formats._numbers import Lines, NumberError, parse_floats, split_lines, tokens_per_line
from tempose.formats._obj_faces import keyword_rows, read_corners, read_groups
from tempose.formats._obj_text import encoder
from tempose.formats._polygons import fan, triangles_of_polygons
from tempose.formats._topology import Frame, other_counts, same_topology
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, IntArray

__all__ = ["encoder", "read_first", "read_next"]

_VERTEX = (ord("v") * 256 + 32, ord("v") * 256 + 9)
_TEXTURE = (ord("v") * 256 + ord("t"),)
_FACE = (ord("f") * 256 + 32, ord("f") * 256 + 9)


def read_first(path: str) -> Frame:
    """Read one OBJ file.

    Parameters
    ----------
    path : str
        File to read.

    Returns
    -------
    Frame
        Its mesh in the axes and unit of the file.

    Raises
    ------
    FormatError
        If it is no OBJ mesh; the message names the line.
    """
    lines = split_lines(read_bytes(path, "an OBJ mesh"))
    is_vertex, is_uv, is_face = (np.isin(lines.keys, keys) for keys in (_VERTEX, _TEXTURE, _FACE))
    if not is_vertex.any() or not is_face.any():
        missing = "vertices ('v' lines)" if not is_vertex.any() else "faces ('f' lines)"
        raise FormatError(f"{path}: expected an OBJ mesh, found no {missing} in {len(lines.starts)} lines")
    table, counts = _table(path, lines, is_vertex, 1, "vertex", 3)
    V, colors, notes = _split_colors(table, counts)
    face_text = lines.block(is_face, 1)
    corners = read_corners(path, lines, is_face, face_text, is_vertex, is_uv)
    uv, uv_corners = None, corners.uv
    if uv_corners is not None:
        uv = _table(path, lines, is_uv, 2, "texture vertex", 1)[0][:, :2]
        uv = np.pad(uv, ((0, 0), (0, 2 - uv.shape[1])))
        if (uv_corners < 0).any():
            uv_corners = np.where(uv_corners < 0, len(uv), uv_corners)
            uv = np.append(uv, [[0.0, 0.0]], axis=0)
            notes += ("corners without texture coordinates were given (0, 0)",)
    groups, name = _groups(lines, is_face, corners.counts)
    mesh = Mesh(
        V,
        fan(corners.vertex, corners.counts),
        uv,
        None if uv_corners is None else fan(uv_corners, corners.counts),
        colors,
        groups,
        None if (corners.counts == 3).all() else corners.counts,
        name or Path(path).stem,
    )
    return Frame(mesh, path, notes, face_text)


def read_next(path: str, first: Frame) -> FloatArray:
    """Read the positions of a later frame and check that it is the same mesh.

    Parameters
    ----------
    path : str
        File to read.
    first : Frame
        First frame of the sequence.

    Returns
    -------
    (n, 3) ndarray of float64
        Positions in the axes and unit of the file.

    Raises
    ------
    FormatError
        If the file is no OBJ mesh or has other vertices or faces than the first.
    """
    lines = split_lines(read_bytes(path, "an OBJ mesh"))
    is_vertex, is_face = (np.isin(lines.keys, keys) for keys in (_VERTEX, _FACE))
    if b"-" in first.face_text or lines.block(is_face, 1) != first.face_text:
        return same_topology(read_first(path).mesh, path, first)
    if int(is_vertex.sum()) != len(first.mesh.vertices):
        raise other_counts(path, int(is_vertex.sum()), "vertices", first.path, len(first.mesh.vertices))
    return _table(path, lines, is_vertex, 1, "vertex", 3)[0][:, :3]


def _table(
    path: str, lines: Lines, mask: np.ndarray, keyword_length: int, what: str, least: int
) -> tuple[FloatArray, IntArray]:
    """(rows, c) numbers of the chosen lines, c the smallest count, and the count of every row."""
    block = lines.block(mask, keyword_length)
    counts = tokens_per_line(block)
    rows = np.flatnonzero(mask)
    try:
        numbers = parse_floats(block)
    except NumberError:
        numbers = np.zeros(0)
    if len(numbers) != counts.sum() or (counts < least).any() or not np.isfinite(numbers).all():
        row = int(rows[_first_bad(block, least)])
        raise FormatError(
            f"{path}, line {row + 1}: expected {what} with {least} or more finite numbers, "
            f"found {excerpt(lines.line(row))}"
        )
    width = int(counts.min())
    if (counts == width).all():
        return numbers.reshape(-1, width), counts
    begins = np.cumsum(counts) - counts
    return numbers[begins[:, None] + np.arange(width)], counts


def _first_bad(block: bytes, least: int) -> int:
    for k, line in enumerate(block.split(b"\n")):
        try:
            numbers = [float(word) for word in line.split()]
        except ValueError:
            return k
        if len(numbers) < least or not np.isfinite(numbers).all() or b"_" in line:
            return k
    return 0


def _split_colors(
    table: FloatArray, counts: IntArray
) -> tuple[FloatArray, FloatArray | None, tuple[str, ...]]:
    if table.shape[1] not in (6, 7):
        return table[:, :3], None, ()
    colors = table[:, 3:6]
    notes: tuple[str, ...] = ()
    if colors.max() > 1:
        colors, notes = colors / 255.0, ("vertex colours were divided by 255",)
    return table[:, :3], np.clip(colors, 0.0, 1.0), notes


def _groups(lines: Lines, is_face: np.ndarray, counts: IntArray) -> tuple[dict[str, IntArray], str]:
    """Triangles per group and the name of the one object, if there is one."""
    objects = keyword_rows(lines, b"o")
    name = ""
    if len(objects) == 1:
        name = lines.line(int(objects[0]))[1:].decode("utf-8", "replace").strip()
    found = read_groups(lines, is_face, b"g")
    if not found:
        found = read_groups(lines, is_face, b"o") if len(objects) > 1 else {}
        found |= read_groups(lines, is_face, b"usemtl")
    return {group: triangles_of_polygons(np.unique(p), counts) for group, p in found.items()}, name
