"""Body of a PLY file: tables of numbers, as text or binary, with lists of any length in their rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats._input import excerpt
from tempose.formats._numbers import NumberError, parse_floats
from tempose.formats._ply_header import Element, Header
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Column:
    """Values of one property over all rows."""

    values: FloatArray | IntArray
    """(rows,) values, or those of all lists one after the other."""
    counts: IntArray | None = None
    """(rows,) list lengths; None for single values."""


Tables = dict[str, dict[str, Column]]


def read_body(path: str, data: bytes, header: Header) -> Tables:
    """Read all tables of a file.

    Parameters
    ----------
    path : str
        File to name in messages.
    data : bytes
        The whole file.
    header : Header
        What its header says.

    Returns
    -------
    dict
        Element name to property name to column.

    Raises
    ------
    FormatError
        If the body is shorter than the header says or holds other things than numbers.
    """
    body = data[header.body :]
    cells = _text_cells(path, body, header) if header.order == "" else np.frombuffer(body, np.uint8)
    tables: Tables = {}
    begin = 0
    for element in header.elements:
        reader = _Rows(path, element, cells, _types(element, header.order))
        tables[element.name], begin = reader.table(begin)
    return tables


def _text_cells(path: str, body: bytes, header: Header) -> FloatArray:
    try:
        return parse_floats(body)
    except NumberError:
        for number, line in enumerate(body.split(b"\n"), start=header.lines + 1):
            try:
                parse_floats(line)
            except NumberError:
                raise FormatError(f"{path}, line {number}: expected numbers, found {excerpt(line)}") from None
        raise FormatError(f"{path}: expected numbers after the PLY header") from None


def _types(element: Element, order: str) -> list[tuple[np.dtype | None, np.dtype]]:
    """Types of list length (None without one) and value of every property; in text all are float64."""
    if order == "":
        number = np.dtype(np.float64)
        return [(number if p.count_kind else None, number) for p in element.properties]
    return [
        (np.dtype(order + p.count_kind) if p.count_kind else None, np.dtype(order + p.kind))
        for p in element.properties
    ]


@dataclass(frozen=True)
class _Rows:
    """Cells (bytes, or the numbers of a text) seen as rows of one element."""

    path: str
    element: Element
    cells: np.ndarray
    types: list[tuple[np.dtype | None, np.dtype]]

    def table(self, begin: int) -> tuple[dict[str, Column], int]:
        """Columns of the element and where the next one begins: fast if all rows look like the first."""
        element, names = self.element, [p.name for p in self.element.properties]
        least = sum((count or value).itemsize for count, value in self.types) // self.cells.itemsize
        if element.count * least > len(self.cells) - begin:
            raise self.too_short((len(self.cells) - begin) // max(least, 1))
        if element.count == 0 or not names:
            empty = [Column(np.zeros(0), np.zeros(0, np.int64) if c else None) for c, _ in self.types]
            return dict(zip(names, empty)), begin
        row, end = self.row(begin, 0)
        stop = begin + element.count * (end - begin)
        if stop <= len(self.cells):
            columns = self.uniform(self.cells[begin:stop], [len(values) for values in row])
            if columns is not None:
                return dict(zip(names, columns)), stop
        columns, stop = self.walk(begin)
        return dict(zip(names, columns)), stop

    def uniform(self, cells: np.ndarray, lengths: list[int]) -> list[Column] | None:
        """Columns if every list has the given length in every row, else None."""
        fields: list[tuple[str, np.dtype, tuple[int, ...]]] = []
        for k, ((count, value), length) in enumerate(zip(self.types, lengths)):
            if count is not None:
                fields.append((f"n{k}", count, ()))
            fields.append((f"v{k}", value, (length,)))
        table = cells.view(np.dtype(fields))
        columns: list[Column] = []
        for k, ((count, value), length) in enumerate(zip(self.types, lengths)):
            if count is not None and not (table[f"n{k}"] == length).all():
                return None
            values = table[f"v{k}"].reshape(-1).astype(value.newbyteorder("="))
            columns.append(Column(values, None if count is None else np.full(len(table), length)))
        return columns

    def walk(self, begin: int) -> tuple[list[Column], int]:
        """Columns of rows that differ in length, read one by one."""
        rows: list[list[np.ndarray]] = []
        for k in range(self.element.count):
            row, begin = self.row(begin, k)
            rows.append(row)
        columns: list[Column] = []
        for (count, value), parts in zip(self.types, zip(*rows)):
            counts = None if count is None else np.array([len(part) for part in parts])
            columns.append(Column(np.concatenate(parts).astype(value.newbyteorder("=")), counts))
        return columns, begin

    def row(self, begin: int, k: int) -> tuple[list[np.ndarray], int]:
        """Values of every property of row `k` and where the next row begins."""
        values: list[np.ndarray] = []
        for count, value in self.types:
            length = 1
            if count is not None:
                stated = float(self.take(begin, 1, count, k)[0])
                if not (stated >= 0 and stated.is_integer()):
                    raise FormatError(
                        f"{self.path}: expected a list length in row {k} of '{self.element.name}', "
                        f"found {stated:g}"
                    )
                length, begin = int(stated), begin + self.size(count)
            values.append(self.take(begin, length, value, k))
            begin += length * self.size(value)
        return values, begin

    def take(self, begin: int, length: int, kind: np.dtype, k: int) -> np.ndarray:
        """Return a few values of one type, if the file still holds them."""
        stop = begin + length * self.size(kind)
        if stop > len(self.cells):
            raise self.too_short(k)
        return self.cells[begin:stop].view(kind)

    def size(self, kind: np.dtype) -> int:
        """How many cells a value takes."""
        return kind.itemsize // self.cells.itemsize

    def too_short(self, k: int) -> FormatError:
        """Say that the file ends before the table does."""
        return FormatError(
            f"{self.path}: expected {self.element.count} rows of '{self.element.name}' as its header says, "
            f"found the end of the file in row {k}"
        )
