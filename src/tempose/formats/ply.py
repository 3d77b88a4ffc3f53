"""Stanford PLY: text and binary, polygons, texture coordinates of vertices or corners, colours."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tempose.clips import Mesh
from tempose.formats._group_sets import groups_of_sets
from tempose.formats._input import read_bytes
from tempose.formats._ply_body import Column, Tables, read_body
from tempose.formats._ply_header import Header, read_header
from tempose.formats._ply_write import GROUPS_COMMENT, NAME_COMMENT, encoder, parse_set
from tempose.formats._polygons import fan
from tempose.formats._topology import Frame, same_topology
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, IntArray

__all__ = ["encoder", "read_first", "read_next"]

_UV_NAMES = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
_COLOR_NAMES = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))


def read_first(path: str) -> Frame:
    """Read one PLY file.

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
        If it is no PLY mesh; the message names the line or row.
    """
    data = read_bytes(path, "a PLY mesh", b"ply", text=False)
    header = read_header(path, data)
    tables = read_body(path, data, header)
    V = _positions(path, tables)
    vertex, face = tables["vertex"], tables.get("face", {})
    corners, counts = _corners(path, face, len(V))
    uv, uv_faces, notes = _texture(vertex, face, counts)
    name, groups = _comments(header, face, counts)
    mesh = Mesh(
        V,
        fan(corners, counts),
        uv,
        uv_faces,
        _colors(vertex),
        groups,
        None if (counts == 3).all() else counts,
        name or Path(path).stem,
    )
    return Frame(mesh, path, notes, _after_vertices(data, header))


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
        If the file is no PLY mesh or has other vertices or faces than the first.
    """
    data = read_bytes(path, "a PLY mesh", b"ply", text=False)
    header = read_header(path, data)
    same = first.face_text and _after_vertices(data, header) == first.face_text
    if not same or header.elements[0].count != len(first.mesh.vertices):
        return same_topology(read_first(path).mesh, path, first)
    alone = Header(header.order, header.elements[:1], (), header.body, header.lines)
    return _positions(path, read_body(path, data, alone))


def _after_vertices(data: bytes, header: Header) -> bytes:
    """Bytes that equal files share: tables after the vertices, with their types; empty where unknown."""
    vertex = header.elements[0] if header.elements else None
    if header.order == "" or vertex is None or vertex.name != "vertex":
        return b""
    if any(p.count_kind for p in vertex.properties):
        return b""
    row = sum(np.dtype(p.kind).itemsize for p in vertex.properties)
    return repr((header.order, header.elements[1:])).encode() + data[header.body + vertex.count * row :]


def _positions(path: str, tables: Tables) -> FloatArray:
    columns = [tables.get("vertex", {}).get(axis) for axis in "xyz"]
    if any(c is None or c.counts is not None for c in columns):
        raise FormatError(f"{path}: expected vertices with x, y and z, found none in the PLY header")
    V = np.stack([c.values for c in columns if c is not None], axis=1).astype(np.float64)
    if not np.isfinite(V).all():
        row = int(np.argmax(~np.isfinite(V).all(axis=1)))
        raise FormatError(f"{path}: expected finite positions, found {V[row].tolist()} at vertex {row}")
    if len(V) == 0:
        raise FormatError(f"{path}: expected a mesh, found 0 vertices")
    return V


def _corners(path: str, face: dict[str, Column], n: int) -> tuple[IntArray, IntArray]:
    column = face.get("vertex_indices") or face.get("vertex_index")
    if column is None or column.counts is None or len(column.counts) == 0:
        raise FormatError(f"{path}: expected faces with vertex_indices, found none; it may be a point cloud")
    short = column.counts < 3
    if short.any():
        row = int(np.argmax(short))
        raise FormatError(f"{path}: expected 3 or more corners, found {column.counts[row]} in face {row}")
    good = (column.values >= 0) & (column.values < n) & (column.values == column.values // 1)
    if not good.all():
        corner = int(np.argmax(~good))
        row = int(np.searchsorted(np.cumsum(column.counts), corner, side="right"))
        raise FormatError(
            f"{path}: expected vertex indices from 0 below {n}, found {column.values[corner]} in face {row}"
        )
    return column.values.astype(np.int64), column.counts


def _texture(
    vertex: dict[str, Column], face: dict[str, Column], counts: IntArray
) -> tuple[FloatArray | None, IntArray | None, tuple[str, ...]]:
    wedge = face.get("texcoord")
    if wedge is not None and wedge.counts is not None and wedge.counts.any():
        if (wedge.counts != 2 * counts).any() or not np.isfinite(wedge.values).all():
            return None, None, ("texture coordinates of corners were left out: not two numbers a corner",)
        corners = wedge.values.astype(np.float64).reshape(-1, 2)
        uv, index = np.unique(corners, axis=0, return_inverse=True)
        return uv, fan(index.reshape(-1), counts), ()
    for names in _UV_NAMES:
        if all(name in vertex and vertex[name].counts is None for name in names):
            uv = np.stack([vertex[name].values for name in names], axis=1).astype(np.float64)
            if np.isfinite(uv).all():
                return uv, None, ()
            return None, None, ("texture coordinates were left out: some are not finite",)
    return None, None, ()


def _colors(vertex: dict[str, Column]) -> FloatArray | None:
    for names in _COLOR_NAMES:
        if all(name in vertex and vertex[name].counts is None for name in names):
            columns = [vertex[name].values for name in names]
            kind: np.dtype = columns[0].dtype
            colors = np.stack(columns, axis=1).astype(np.float64)
            if kind.kind == "u":
                colors /= float(2 ** (8 * kind.itemsize) - 1)
            elif colors.max(initial=0.0) > 1:
                colors /= 255.0
            return np.clip(np.nan_to_num(colors), 0.0, 1.0)
    return None


def _comments(header: Header, face: dict[str, Column], counts: IntArray) -> tuple[str, dict[str, IntArray]]:
    """Name and groups, which PLY has no place for: they stand in comments that `encoder` writes."""
    name = next((c.partition(" ")[2] for c in header.comments if c.startswith(NAME_COMMENT + " ")), "")
    sets = [parse_set(c) for c in header.comments if c.startswith(GROUPS_COMMENT + " ")]
    column = face.get("group_set")
    if not sets or column is None or column.counts is not None:
        return name, {}
    return name, groups_of_sets(column.values.astype(np.int64), [(), *sets], counts)
