"""A mesh as PLY bytes; what does not move is encoded once for all frames."""

from __future__ import annotations

import json

import numpy as np

from tempose.clips import Mesh
from tempose.formats._group_sets import group_sets
from tempose.formats._obj_text import Encoder
from tempose.formats._polygons import unfan
from tempose.typing import FloatArray, IntArray

NAME_COMMENT = "name"
"""Comment that holds the name of the mesh."""
GROUPS_COMMENT = "group_set"
"""Comment that holds the names of the groups of one set, in JSON; a face property numbers the set."""

_PLY_NAMES = {"u1": "uchar", "i4": "int", "f4": "float", "f8": "double"}


def encoder(mesh: Mesh, text: bool = False) -> Encoder:
    """Prepare the bytes of one mesh whose positions change.

    Parameters
    ----------
    mesh : Mesh
        Faces, texture coordinates, colours, groups and name.
    text : bool, default False
        Write ASCII; by default binary, little-endian.

    Returns
    -------
    Encoder
        Takes the positions and gives the file: float32 positions are stored as ``float``, others as
        ``double``.
    """
    extra_names, extra = _vertex_extras(mesh)
    face_header, faces = _faces(mesh, text)

    def encode(V: FloatArray, digits: int | None = None) -> bytes:
        kind = "f4" if V.dtype == np.float32 else "f8"
        columns = [("x", kind), ("y", kind), ("z", kind), *extra_names]
        table = np.concatenate([V.astype(np.float64), extra], axis=1)
        lines = [
            f"ply\nformat {'ascii' if text else 'binary_little_endian'} 1.0",
            *([f"comment {NAME_COMMENT} {_printable(mesh.name)}"] if mesh.name else []),
            f"element vertex {len(V)}",
            *(f"property {_PLY_NAMES[k]} {name}" for name, k in columns),
        ]
        header = "\n".join(lines) + "\n" + face_header + "end_header\n"
        return header.encode() + _rows(table, [k for _, k in columns], text, digits) + faces

    return encode


def parse_set(comment: str) -> tuple[str, ...]:
    """Read the comment that names the groups of a set.

    Parameters
    ----------
    comment : str
        ``group_set`` and a JSON list.

    Returns
    -------
    tuple of str
        Group names; empty if the comment is another one.
    """
    try:
        names = json.loads(comment.partition(" ")[2])
    except (ValueError, RecursionError):
        return ()
    return tuple(str(name) for name in names) if isinstance(names, list) else ()


def _vertex_extras(mesh: Mesh) -> tuple[list[tuple[str, str]], FloatArray]:
    """Properties beside the position: texture coordinates of vertices, colours."""
    names: list[tuple[str, str]] = []
    columns: list[FloatArray] = [np.zeros((len(mesh.vertices), 0))]
    if mesh.uv is not None and mesh.uv_faces is None:
        names += [("s", "f8"), ("t", "f8")]
        columns.append(mesh.uv)
    if mesh.colors is not None:
        bytes_ = np.rint(mesh.colors * 255)
        exact = bool((bytes_ / 255.0 == mesh.colors).all())
        names += [(name, "u1" if exact else "f8") for name in ("red", "green", "blue")]
        columns.append(bytes_ if exact else mesh.colors)
    return names, np.concatenate(columns, axis=1)


def _faces(mesh: Mesh, text: bool) -> tuple[str, bytes]:
    corners, counts = unfan(mesh.faces, mesh.polygons)
    header = [f"element face {len(counts)}", "property list uchar int vertex_indices"]
    if counts.max(initial=0) > 127:
        header[1] = "property list int int vertex_indices"
    kind = "i4" if counts.max(initial=0) > 127 else "u1"
    wedge = None
    if mesh.uv is not None and mesh.uv_faces is not None:
        wedge = mesh.uv[unfan(mesh.uv_faces, mesh.polygons)[0]].reshape(-1)
        header.append(f"property list {_PLY_NAMES[kind]} double texcoord")
    numbers, comments = None, []
    if mesh.groups:
        numbers, sets = group_sets(mesh, counts)
        comments = [f"comment {GROUPS_COMMENT} {json.dumps(names)}" for names in sets[1:]]
        header.append("property int group_set")
    pieces: list[bytes] = []
    ends = np.cumsum(counts)
    for begin, end in _equal_runs(counts):
        a, b, size = int(ends[begin] - counts[begin]), int(ends[end - 1]), int(counts[begin])
        fields: list[tuple[str, str, tuple[int, ...]]] = [("n", kind, ()), ("v", "<i4", (size,))]
        values: list[np.ndarray | int] = [size, corners[a:b].reshape(-1, size)]
        if wedge is not None:
            fields += [("m", kind, ()), ("t", "<f8", (2 * size,))]
            values += [2 * size, wedge[2 * a : 2 * b].reshape(-1, 2 * size)]
        if numbers is not None:
            fields.append(("g", "<i4", ()))
            values.append(numbers[begin:end])
        pieces.append(_records(fields, values, end - begin, text))
    return "\n".join([*header, *comments]) + "\n", b"".join(pieces)


def _records(
    fields: list[tuple[str, str, tuple[int, ...]]], values: list[np.ndarray | int], count: int, text: bool
) -> bytes:
    table = np.zeros(count, np.dtype(fields))
    for (name, _, _), value in zip(fields, values):
        table[name] = value
    if not text:
        return table.tobytes()
    rows = zip(*(table[name].reshape(count, -1).tolist() for name, _, _ in fields))
    return "".join(" ".join([repr(x) for cell in row for x in cell]) + "\n" for row in rows).encode()


def _equal_runs(counts: IntArray) -> list[tuple[int, int]]:
    if len(counts) == 0:
        return []
    cuts = (np.flatnonzero(np.diff(counts)) + 1).tolist()
    return list(zip([0, *cuts], [*cuts, len(counts)]))


def _rows(table: FloatArray, kinds: list[str], text: bool, digits: int | None) -> bytes:
    if text:
        number = " %r" if digits is None else f" %.{digits}g"
        row = "".join(number if k < 3 else (" %d" if kind == "u1" else " %r") for k, kind in enumerate(kinds))
        return ((row[1:] + "\n") * len(table) % tuple(table.ravel().tolist())).encode()
    result = np.zeros(len(table), np.dtype([(f"c{k}", f"<{kind}") for k, kind in enumerate(kinds)]))
    for k in range(len(kinds)):
        result[f"c{k}"] = table[:, k]
    return result.tobytes()


def _printable(name: str) -> str:
    return "".join(c if c.isprintable() else "_" for c in name).strip()
