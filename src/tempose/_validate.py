"""Checks at the public border: each names the argument, what was expected, what was found."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.typing import FloatArray, IntArray

_INT32 = 2**31


def _shape_text(shape: tuple[int | str, ...]) -> str:
    inner = ", ".join(str(s) for s in shape)
    return f"({inner},)" if len(shape) == 1 else f"({inner})"


def as_floats(value: Any, name: str, shape: tuple[int | str, ...], dtype: Any = np.float64) -> FloatArray:
    """Check a finite float array and convert it.

    Parameters
    ----------
    value : array_like
        What the caller gave.
    name : str
        Name of the argument, for the message.
    shape : tuple of int or str
        Expected shape; a string such as ``"n"`` stands for any length.
    dtype : dtype, default float64
        Type of the result.

    Returns
    -------
    ndarray
        The checked array; a copy only where conversion needs one.

    Raises
    ------
    ValueError
        If the shape is another or a value is NaN or infinite.

    Examples
    --------
    >>> as_floats([[0, 1, 2]], "V", ("n", 3)).shape
    (1, 3)
    """
    array = _as_shape(value, name, shape, dtype)
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name} must be finite, got {array[where]} at index {where}")
    return array


def as_indices(value: Any, name: str, shape: tuple[int | str, ...], limit: int | None = None) -> IntArray:
    """Check an array of 0-based indices and convert it to int32.

    Parameters
    ----------
    value : array_like
        What the caller gave.
    name : str
        Name of the argument, for the message.
    shape : tuple of int or str
        Expected shape; a string stands for any length.
    limit : int, optional
        Every index must be below it.

    Returns
    -------
    ndarray of int32
        The checked array.

    Raises
    ------
    ValueError
        If the shape is another, a value is no integer, negative, or not below `limit`.

    Examples
    --------
    >>> as_indices([[0, 1, 2]], "F", ("m", 3), limit=3).dtype
    dtype('int32')
    """
    try:
        raw = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} must hold integers in shape {_shape_text(shape)}: {error}") from None
    limit = _INT32 if limit is None else limit
    if raw.size and raw.dtype.kind not in "iu":
        raise ValueError(f"{name} must hold integers, got dtype {raw.dtype}")
    if raw.size and (raw.min() < 0 or raw.max() >= limit):
        bad = raw.min() if raw.min() < 0 else raw.max()
        where = tuple(int(i) for i in np.argwhere(raw == bad)[0])
        raise ValueError(f"{name} must hold indices from 0 and below {limit}, got {bad} at index {where}")
    return _as_shape(raw, name, shape, np.int32)


def _as_shape(value: Any, name: str, shape: tuple[int | str, ...], dtype: Any) -> Any:
    try:
        with np.errstate(over="ignore"):  # what overflows float32 becomes infinite, which as_floats refuses
            array = np.asarray(value, dtype=dtype)
    except (OverflowError, TypeError, ValueError) as error:
        raise ValueError(
            f"{name} must be an array of numbers of shape {_shape_text(shape)}: {error}"
        ) from None
    fits = array.ndim == len(shape) and all(
        isinstance(want, str) or want == got for want, got in zip(shape, array.shape)
    )
    if not fits:
        raise ValueError(f"{name} must have shape {_shape_text(shape)}, got {_shape_text(array.shape)}")
    return array


def read_only(array: Any) -> Any:
    """Return a view that refuses writes, so that frozen data stays frozen.

    Parameters
    ----------
    array : ndarray
        Any array or memory map.

    Returns
    -------
    ndarray
        The same memory, not writeable through the result.
    """
    view = array.view()
    view.flags.writeable = False
    return view
