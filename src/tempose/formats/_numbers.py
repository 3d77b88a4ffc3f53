"""Numbers out of text, millions at a time: rows of ASCII numbers to one flat array."""

from __future__ import annotations

import re
import sys
import warnings
from dataclasses import dataclass
from importlib import import_module

import numpy as np

from tempose.typing import BoolArray, FloatArray, IntArray

_SPACE = 32
_NEWLINE = 10
_KERNEL = "tempose.formats._number_kernel"
_WORTH_COMPILER = 16_000_000
_COMMENT = re.compile(rb"#[^\n]*")


class NumberError(ValueError):
    """A block of text that holds something else than numbers."""


@dataclass(frozen=True)
class Lines:
    """Text with the places where its lines begin."""

    data: bytes
    """The text; ends with a newline."""
    starts: IntArray
    """(l,) first byte of every line."""
    keys: IntArray
    """(l,) first byte * 256 + second byte of every line."""

    def line(self, index: int) -> bytes:
        """Return one line without its end.

        Parameters
        ----------
        index : int
            0-based line.

        Returns
        -------
        bytes
            Its text.
        """
        start = int(self.starts[index])
        return self.data[start : self.data.index(b"\n", start)]

    def block(self, mask: BoolArray, keyword_length: int) -> bytes:
        """Return the chosen lines joined, their keywords blanked, comments dropped.

        Parameters
        ----------
        mask : (l,) bool
            Which lines.
        keyword_length : int
            How many bytes to blank at the start of each.

        Returns
        -------
        bytes
            As many lines as were chosen.
        """
        rows = np.flatnonzero(mask)
        if len(rows) == 0:
            return b""
        ends = np.append(self.starts[1:], len(self.data))
        breaks = np.flatnonzero(np.diff(rows) > 1)
        first = self.starts[rows[np.append(0, breaks + 1)]].tolist()
        last = ends[rows[np.append(breaks, len(rows) - 1)]].tolist()
        joined = bytearray(b"".join([self.data[a:b] for a, b in zip(first, last)]))
        text = np.frombuffer(joined, np.uint8)
        begins = np.append(0, np.flatnonzero(text == _NEWLINE)[:-1] + 1)
        for k in range(keyword_length):
            text[begins + k] = _SPACE
        return _COMMENT.sub(b"", bytes(joined)) if b"#" in joined else bytes(joined)


def split_lines(data: bytes) -> Lines:
    """Find the lines of a text; continued lines and indentation are flattened, line numbers kept.

    Parameters
    ----------
    data : bytes
        Text with any kind of line ends.

    Returns
    -------
    Lines
        Text and line starts.
    """
    if b"\r" in data and b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    if b"\\" in data:
        data = re.sub(rb"\\[ \t]*\r?\n", b"  ", data)
    if not data.endswith(b"\n"):
        data += b"\n"
    text = np.frombuffer(data, np.uint8)
    starts = np.append(0, np.flatnonzero(text == _NEWLINE)[:-1] + 1)
    first = text[starts]
    if ((first == _SPACE) | (first == 9)).any():
        stripped = b"\n".join([line.lstrip(b" \t") for line in data[:-1].split(b"\n")]) + b"\n"
        if stripped != data:
            return split_lines(stripped)
    second = text[np.minimum(starts + 1, len(text) - 1)]
    return Lines(data, starts, first.astype(np.int32) * 256 + second)


def tokens_per_line(block: bytes) -> IntArray:
    """Count the words of every line.

    Parameters
    ----------
    block : bytes
        Lines, each ended by a newline.

    Returns
    -------
    (l,) ndarray of int
        Words per line.
    """
    text = np.frombuffer(block, np.uint8)
    if len(text) == 0:
        return np.zeros(0, np.int64)
    ink = text > _SPACE
    begins = ink.copy()
    begins[1:] &= ~ink[:-1]
    totals = np.searchsorted(np.flatnonzero(begins), np.flatnonzero(text == _NEWLINE))
    return np.diff(totals, prepend=0)


def parse_floats(block: bytes) -> FloatArray:
    """Read every word of a text as a number.

    Parameters
    ----------
    block : bytes
        Words separated by white space.

    Returns
    -------
    (k,) ndarray of float64
        The numbers, correctly rounded.

    Raises
    ------
    NumberError
        If a word is no number.
    """
    use_kernel_for(len(block))
    kernel = sys.modules.get(_KERNEL)
    values = None if kernel is None else kernel.read_floats(block)
    return _parse(block, np.float64) if values is None else values


def use_kernel_for(size: int) -> None:
    """Import the compiled reader if there is enough text to pay for loading the compiler.

    Parameters
    ----------
    size : int
        Bytes of text about to be read.
    """
    if size > _WORTH_COMPILER:
        import_module(_KERNEL)


def parse_ints(block: bytes) -> IntArray:
    """Read every word of a text as an integer.

    Parameters
    ----------
    block : bytes
        Words separated by white space.

    Returns
    -------
    (k,) ndarray of int64
        The integers.

    Raises
    ------
    NumberError
        If a word is no integer.
    """
    return _parse(block, np.int64)


def _parse(block: bytes, dtype: type) -> np.ndarray:
    if not block.strip():
        return np.zeros(0, dtype)
    try:
        with warnings.catch_warnings():
            # numpy below 2.3 warns about a bad word where later ones raise
            warnings.simplefilter("error", DeprecationWarning)
            return np.fromstring(block, dtype, sep=" ")
    except (ValueError, DeprecationWarning, OverflowError):
        raise NumberError("not a number") from None
