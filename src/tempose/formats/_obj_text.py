"""A mesh as OBJ text; what does not move is encoded once for all frames."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tempose.clips import Mesh
from tempose.formats._group_sets import group_sets
from tempose.formats._polygons import unfan
from tempose.typing import FloatArray, IntArray


class Encoder(Protocol):
    """Turns the positions of one frame into the bytes of its file."""

    def __call__(self, V: FloatArray, digits: int | None = None) -> bytes:
        """Encode a frame.

        Parameters
        ----------
        V : (n, 3) float
            Positions in the axes and unit of the file.
        digits : int, optional
            Digits of a coordinate in text; None for as many as it takes to read the same numbers back.

        Returns
        -------
        bytes
            The whole file.
        """
        ...


def encoder(mesh: Mesh) -> Encoder:
    """Prepare the text of one mesh whose positions change.

    Parameters
    ----------
    mesh : Mesh
        Faces, texture coordinates, colours, groups and name.

    Returns
    -------
    Encoder
        Takes the positions and gives the text.
    """
    head = f"o {_word(mesh.name, spaces=True)}\n" if mesh.name else ""
    tail = _texture_text(mesh) + _face_text(mesh)

    def encode(V: FloatArray, digits: int | None = None) -> bytes:
        return (head + _vertex_text(V, mesh.colors, digits) + tail).encode()

    return encode


def _vertex_text(V: FloatArray, colors: FloatArray | None, digits: int | None) -> str:
    number = " %r" if digits is None else f" %.{digits}g"
    row = "v" + number * 3 + ("" if colors is None else " %r" * 3) + "\n"
    table = np.asarray(V, np.float64)
    table = table if colors is None else np.concatenate([table, colors], axis=1)
    return (row * len(table)) % tuple(table.ravel().tolist())


def _texture_text(mesh: Mesh) -> str:
    if mesh.uv is None:
        return ""
    return ("vt %r %r\n" * len(mesh.uv)) % tuple(mesh.uv.ravel().tolist())


def _face_text(mesh: Mesh) -> str:
    vertex, counts = unfan(mesh.faces, mesh.polygons)
    columns = vertex[:, None] + 1
    corner = " %d"
    if mesh.uv is not None:
        uv = vertex if mesh.uv_faces is None else unfan(mesh.uv_faces, mesh.polygons)[0]
        columns, corner = np.stack([vertex, uv], axis=1) + 1, " %d/%d"
    kinds = {int(c): "f" + corner * int(c) + "\n" for c in np.unique(counts)}
    begins = np.append(0, np.cumsum(counts))
    pieces: list[str] = []
    for begin, end, line in _group_runs(mesh, counts):
        pieces.append(line)
        row = "".join([kinds[c] for c in counts[begin:end].tolist()])
        pieces.append(row % tuple(columns[begins[begin] : begins[end]].ravel().tolist()))
    return "".join(pieces)


def _group_runs(mesh: Mesh, counts: IntArray) -> list[tuple[int, int, str]]:
    """List runs of polygons that are in the same groups, each with the line that opens it."""
    p = len(counts)
    if not mesh.groups or p == 0:
        return [(0, p, "")]
    numbers, sets = group_sets(mesh, counts)
    begins = [0, *(np.flatnonzero(np.diff(numbers)) + 1).tolist()]
    opening = [" ".join(["g", *map(_word, sets[numbers[b]])]) + "\n" for b in begins]
    return list(zip(begins, [*begins[1:], p], opening))


def _word(name: str, spaces: bool = False) -> str:
    """Make a name that survives in one line: no line ends, no comment signs, no blanks in group names."""
    clean = "".join("_" if c in "#\\" or not c.isprintable() else c for c in name).strip()
    return clean if spaces else "_".join(clean.split())
