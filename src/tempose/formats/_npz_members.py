"""Arrays of a ``.npz`` or ``.npy`` file, sizes checked before anything is allocated, never unpickled."""

from __future__ import annotations

import math
import struct
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np

from tempose.formats._input import unreadable
from tempose.formats.conventions import FormatError

# what zipfile, zlib and the header parser of numpy are known to raise on damaged files
_BROKEN = (
    ValueError, KeyError, IndexError, TypeError, EOFError, OSError, RuntimeError, NotImplementedError,
    OverflowError, AttributeError, SyntaxError, MemoryError, zipfile.BadZipFile, zlib.error, struct.error,
    tokenize.TokenError,
)  # fmt: skip
_DEFLATE_LIMIT = 1032
"""Deflate never expands more than this, so a member that claims more lies (zlib technical details)."""


def read_members(path: str, keys: tuple[str, ...], prefix: str) -> tuple[dict[str, Any], list[str]]:
    """Read the arrays of a ``.npz`` archive that have known names.

    Parameters
    ----------
    path : str
        File to read.
    keys : tuple of str
        Names of arrays to read; others are left alone.
    prefix : str
        Arrays whose name begins so are read too.

    Returns
    -------
    arrays : dict of str to ndarray
        Arrays by name.
    names : list of str
        Names of all arrays, read or not.

    Raises
    ------
    FormatError
        If the archive or an array in it is broken or needs pickle.
    """
    name = ""
    try:
        with zipfile.ZipFile(path) as archive:
            arrays: dict[str, Any] = {}
            names: list[str] = []
            size = Path(path).stat().st_size
            for info in archive.infolist():
                name = info.filename
                key = name.removesuffix(".npy")
                names.append(key)
                if key not in keys and not key.startswith(prefix):
                    continue
                if not 0 <= info.file_size <= _DEFLATE_LIMIT * min(info.compress_size, size) + 64:
                    raise ValueError(f"states {info.file_size} bytes, more than the file can hold")
                with archive.open(info) as stream:
                    arrays[key] = _read_array(stream, info.file_size)
            return arrays, names
    except OSError as error:
        raise FormatError(unreadable(path, error)) from None
    except _BROKEN as error:
        place = f", array {name!r}" if name else ""
        raise FormatError(f"{path}{place}: expected a numpy archive (.npz): {_one_line(error)}") from None


def read_single(path: str) -> Any:
    """Read the array of a ``.npy`` file.

    Parameters
    ----------
    path : str
        File to read.

    Returns
    -------
    ndarray
        The array.

    Raises
    ------
    FormatError
        If it is broken or needs pickle.
    """
    try:
        with open(path, "rb") as stream:
            return _read_array(stream, Path(path).stat().st_size)
    except OSError as error:
        raise FormatError(unreadable(path, error)) from None
    except _BROKEN as error:
        raise FormatError(f"{path}: expected a numpy array (.npy): {_one_line(error)}") from None


class FrameBlocks:
    """An array that is made block by block while it is written, along its first axis."""

    dtype: np.dtype[Any]
    """Type of the numbers."""
    shape: tuple[int, ...]
    """Shape of the whole."""

    def blocks(self) -> Iterator[Any]:
        """Make the blocks in order.

        Yields
        ------
        ndarray
            Of `dtype`; together they have `shape`.
        """
        raise NotImplementedError


def write_members(stream: IO[bytes], arrays: dict[str, Any]) -> None:
    """Write arrays as a ``.npz`` archive, the same bytes for the same arrays.

    Parameters
    ----------
    stream : binary file
        Where to write.
    arrays : dict of str to ndarray or FrameBlocks
        Arrays by name; none may hold Python objects.
    """
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            with archive.open(zipfile.ZipInfo(name + ".npy"), "w", force_zip64=True) as member:
                write_array(member, array)


def write_array(stream: IO[bytes], array: Any) -> None:
    """Write an array as numpy does.

    Parameters
    ----------
    stream : binary file
        Where to write.
    array : ndarray or FrameBlocks
        What to write; no Python objects.
    """
    if not isinstance(array, FrameBlocks):
        np.lib.format.write_array(stream, np.asarray(array), allow_pickle=False)
        return
    head = {"descr": np.lib.format.dtype_to_descr(array.dtype), "fortran_order": False, "shape": array.shape}
    np.lib.format.write_array_header_1_0(stream, head)
    for block in array.blocks():
        stream.write(np.ascontiguousarray(block, dtype=array.dtype).tobytes())


def _read_array(stream: IO[bytes], size: int) -> Any:
    version = np.lib.format.read_magic(stream)
    header = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }.get(version)
    if header is None:
        raise ValueError(f"unknown version {version} of the numpy format")
    with warnings.catch_warnings():
        # headers of Python 2 and some damaged ones are warned about; the checks below decide
        warnings.simplefilter("ignore")
        shape, fortran, dtype = header(stream)
    if dtype.hasobject:
        raise ValueError("holds Python objects, which are never unpickled")
    length = math.prod(shape) * dtype.itemsize
    if length > size or len(shape) > 8:
        raise ValueError(f"its header states shape {shape}, more than its {size} bytes hold")
    data = stream.read(length)
    if len(data) < length:
        raise ValueError(f"expected {length} bytes of shape {shape}, found {len(data)}")
    array = np.frombuffer(data, dtype, math.prod(shape))
    return array.reshape(shape, order="F" if fortran else "C")


def _one_line(error: BaseException) -> str:
    return (" ".join(str(error).split()) or type(error).__name__)[:200]
