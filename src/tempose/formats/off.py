"""OFF, the Object File Format of Geomview: vertices and polygons in text, perhaps with vertex colours."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np

from tempose.clips import Mesh
from tempose.formats._input import excerpt, read_bytes
from tempose.formats._numbers import NumberError, parse_floats, tokens_per_line
from tempose.formats._obj_text import Encoder
from tempose.formats._polygons import fan, unfan
from tempose.formats._topology import Frame, same_topology
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, IntArray


def read_first(path: str) -> Frame:
    """Read one OFF file.

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
        If it is no OFF mesh.
    """
    data = re.sub(rb"#[^\n]*", b"", read_bytes(path, "an OFF mesh").replace(b"\r", b"\n"))
    keyword, _, body = data.lstrip().partition(b"OFF")
    if keyword not in (b"", b"C") or not body:
        raise FormatError(f"{path}: expected an OFF mesh (OFF or COFF), found {excerpt(data[:40])}")
    # every row on a line of its own, no empty lines
    body = b"\n".join([line for line in body.split(b"\n") if line.strip()]) + b"\n"
    per_row = tokens_per_line(body)
    try:
        numbers = parse_floats(body)
    except NumberError:
        raise FormatError(f"{path}: expected numbers after 'OFF', found {_first_word(body)}") from None
    begins = np.cumsum(per_row) - per_row
    n, p = _sizes(path, numbers, per_row)
    V, colors = _vertices(path, numbers, begins[1 : n + 1], per_row[1 : n + 1], keyword == b"C")
    corners, counts = _polygons(path, numbers, begins[n + 1 : n + 1 + p], per_row[n + 1 : n + 1 + p], n)
    polygons = None if (counts == 3).all() else counts
    mesh = Mesh(V, fan(corners, counts), colors=colors, polygons=polygons, name=Path(path).stem)
    return Frame(mesh, path)


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
        If the file is no OFF mesh or has other vertices or faces than the first.
    """
    return same_topology(read_first(path).mesh, path, first)


def encoder(mesh: Mesh) -> Encoder:
    """Prepare the text of one mesh whose positions change; the format holds only positions and polygons.

    Parameters
    ----------
    mesh : Mesh
        Its faces.

    Returns
    -------
    Encoder
        Takes the positions and gives the text.
    """
    corners, counts = unfan(mesh.faces, mesh.polygons)
    begins = np.append(0, np.cumsum(counts)).tolist()
    words = list(map(str, corners.tolist()))
    rows = [f"{b - a} {' '.join(words[a:b])}\n" for a, b in itertools.pairwise(begins)]
    head, tail = f"OFF\n{len(mesh.vertices)} {len(counts)} 0\n", "".join(rows)

    def encode(V: FloatArray, digits: int | None = None) -> bytes:
        number = "%r" if digits is None else f"%.{digits}g"
        row = " ".join([number] * 3) + "\n"
        return (head + row * len(V) % tuple(np.asarray(V, np.float64).ravel().tolist()) + tail).encode()

    return encode


def _sizes(path: str, numbers: FloatArray, per_row: IntArray) -> tuple[int, int]:
    n, p = numbers[:2] if len(per_row) and per_row[0] >= 2 else (0.0, 0.0)
    if not (n > 0 and p > 0 and n % 1 == 0 and p % 1 == 0):
        raise FormatError(
            f"{path}: expected counts of vertices and faces after 'OFF', found {numbers[:2].tolist()}"
        )
    if 1 + n + p > len(per_row):
        raise FormatError(
            f"{path}: expected {n:.0f} vertices and {p:.0f} faces as its header says, "
            f"found {len(per_row) - 1} rows"
        )
    return int(n), int(p)


def _vertices(
    path: str, numbers: FloatArray, begins: IntArray, per_row: IntArray, colored: bool
) -> tuple[FloatArray, FloatArray | None]:
    width = 6 if colored and (per_row >= 6).all() else 3
    if (per_row < width).any():
        raise FormatError(f"{path}: expected 3 numbers in vertex {int(np.argmax(per_row < width))}")
    table = numbers[begins[:, None] + np.arange(width)]
    if not np.isfinite(table).all():
        row = int(np.argmax(~np.isfinite(table).all(axis=1)))
        raise FormatError(f"{path}: expected finite positions, found {table[row].tolist()} at vertex {row}")
    if width == 3:
        return table, None
    scale = 255.0 if table[:, 3:].max() > 1 else 1.0
    return table[:, :3], np.clip(table[:, 3:] / scale, 0.0, 1.0)


def _polygons(
    path: str, numbers: FloatArray, begins: IntArray, per_row: IntArray, n: int
) -> tuple[IntArray, IntArray]:
    counts = numbers[begins]
    good = (counts >= 3) & (counts < per_row) & (counts % 1 == 0)
    if not good.all():
        row = int(np.argmax(~good))
        raise FormatError(f"{path}: expected a count and 3 or more corners in face {row}")
    counts = counts.astype(np.int64)
    first_corner = np.repeat(begins + 1 - (np.cumsum(counts) - counts), counts)
    corners = numbers[first_corner + np.arange(int(counts.sum()))]
    good = (corners >= 0) & (corners < n) & (corners % 1 == 0)
    if not good.all():
        corner = int(np.argmax(~good))
        row = int(np.searchsorted(np.cumsum(counts), corner, side="right"))
        raise FormatError(
            f"{path}: expected vertex indices below {n}, found {corners[corner]:g} in face {row}"
        )
    return corners.astype(np.int64), counts


def _first_word(body: bytes) -> str:
    for word in body.split():
        try:
            float(word)
        except ValueError:
            return excerpt(word)
    return "something else"
