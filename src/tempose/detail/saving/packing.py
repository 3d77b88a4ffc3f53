"""Arrays as short strings of bytes, without loss."""

from __future__ import annotations

import zlib
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

ByteArray: TypeAlias = npt.NDArray[np.uint8]

_LARGEST = 2**33
"""Bytes that an array may claim to hold."""


def pack(array: Any) -> tuple[ByteArray, dict[str, Any]]:
    """Squeeze an array.

    Parameters
    ----------
    array : ndarray
        Numbers of any type.

    Returns
    -------
    packed : (b,) uint8 ndarray
        Bytes, those of equal weight together, since they are alike.
    how : dict
        What `unpack` needs beside them, as JSON can hold it.
    """
    array = np.asarray(array)
    how: dict[str, Any] = {"type": array.dtype.str, "shape": list(array.shape)}
    stored = _shorter(array)
    if stored.dtype.kind in "iu" and stored.ndim == 2 and len(stored) > 1:
        how["differences"] = True
        stored = _shorter(np.diff(stored.astype(np.int64), axis=0, prepend=0))
    if stored.dtype.kind == "i":
        stored = _folded(stored)
        how["folded"] = True
    how["stored"] = stored.dtype.str
    planes = np.ascontiguousarray(stored).reshape(-1).view(np.uint8).reshape(-1, stored.dtype.itemsize).T
    return np.frombuffer(zlib.compress(planes.tobytes(), 9), np.uint8), how


def unpack(packed: Any, how: dict[str, Any]) -> Any:
    """Undo `pack`.

    Parameters
    ----------
    packed : (b,) uint8
        Bytes.
    how : dict
        What `pack` returned beside them.

    Returns
    -------
    ndarray
        The same array, bit by bit.

    Raises
    ------
    ValueError
        If the bytes are not those of such an array.
    """
    shape = tuple(int(s) for s in how["shape"])
    kind, stored = np.dtype(how["type"]), np.dtype(how["stored"])
    if any(s < 0 for s in shape) or "O" in (kind.kind, stored.kind):
        raise ValueError(f"an array of shape {shape} and type {how['type']}")
    count = int(np.prod(shape, dtype=object)) if shape else 1
    size = count * stored.itemsize
    # deflate shrinks by a factor of 1032 at most
    if size > min(_LARGEST, 1040 * (len(packed) + 64)):
        raise ValueError(f"an array of {size} bytes packed into {len(packed)}")
    try:
        data = zlib.decompressobj().decompress(np.asarray(packed, dtype=np.uint8).tobytes(), size + 1)
    except zlib.error as error:
        raise ValueError(f"packed numbers are damaged ({error})") from None
    if len(data) != size:
        raise ValueError(f"packed numbers end after {len(data)} of {size} bytes")
    planes = np.frombuffer(data, np.uint8).reshape(stored.itemsize, count)
    values = np.ascontiguousarray(planes.T).reshape(-1).view(stored).reshape(shape)
    if how.get("folded"):
        values = _unfolded(values)
    if how.get("differences"):
        values = np.cumsum(values.astype(np.int64), axis=0)
    return values.astype(kind)


def _shorter(array: Any) -> Any:
    """Return the same numbers in the shortest type."""
    if array.dtype == np.float64:
        with np.errstate(over="ignore"):  # what float32 cannot hold is kept as it is
            short = array.astype(np.float32)
        return short if np.array_equal(short, array, equal_nan=True) else array
    if array.dtype.kind in "iu" and array.size:
        low, high = int(array.min()), int(array.max())
        for kind in (np.int8, np.uint8, np.int16, np.uint16, np.int32):
            if np.iinfo(kind).min <= low and high <= np.iinfo(kind).max:
                return array.astype(kind)
    return array


def _folded(values: Any) -> Any:
    """Signed to unsigned, 0 -1 1 -2 2 ... to 0 1 2 3 4 ..., so that small numbers have empty upper bytes."""
    bits = 8 * values.dtype.itemsize - 1
    return ((values << 1) ^ (values >> bits)).view(values.dtype.str.replace("i", "u"))


def _unfolded(values: Any) -> Any:
    signed = values.dtype.str.replace("u", "i")
    return (values >> 1).view(signed) ^ -((values & 1).view(signed))
