"""Values in an edit list, checked by kind; whether they fit the clip, each edit says itself."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from tempose._validate import as_floats

Check = Callable[[Any, str], Any]
"""Takes a value and the name of its key; returns the value as the edit takes it, or raises ValueError."""


def number(value: Any, key: str) -> float:
    """Check a finite number.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    float
        The number.

    Raises
    ------
    ValueError
        If it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise ValueError(f"{key} must be a number, got {value!r}")
    try:
        found = float(value)
    except OverflowError:  # whole numbers of a file may have any length
        found = math.inf
    if not math.isfinite(found):
        raise ValueError(f"{key} must be a finite number, got {found}")
    return found


def whole(value: Any, key: str) -> int:
    """Check a whole number.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    int
        The number.

    Raises
    ------
    ValueError
        If it is none.
    """
    if number(value, key) != int(value):
        raise ValueError(f"{key} must be a whole number, got {value!r}")
    return int(value)


def place(value: Any, key: str) -> Any:
    """Check a pair of numbers.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    (2,) ndarray
        Coordinates in the pose plane.

    Raises
    ------
    ValueError
        If it is none.
    """
    if not isinstance(value, list | tuple | np.ndarray) or len(value) != 2:
        raise ValueError(f"{key} must be two numbers, [x, y], got {value!r}")
    return as_floats(value, key, (2,))


def pairs(value: Any, key: str) -> Any:
    """Check a list of pairs of numbers.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    (N, 2) ndarray
        The pairs.

    Raises
    ------
    ValueError
        If it is none, or empty.
    """
    if not isinstance(value, list | tuple | np.ndarray) or len(value) == 0:
        raise ValueError(f"{key} must be a list of pairs of numbers, [[x, y], ...], got {value!r}")
    return as_floats(value, key, ("N", 2))


def numbers(value: Any, key: str) -> Any:
    """Check a list of numbers.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    (N,) ndarray
        The numbers.

    Raises
    ------
    ValueError
        If it is none, or empty.
    """
    if not isinstance(value, list | tuple | np.ndarray) or len(value) == 0:
        raise ValueError(f"{key} must be a list of numbers, got {value!r}")
    return as_floats(value, key, ("N",))


def text(value: Any, key: str) -> str:
    """Check a text.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    str
        The text.

    Raises
    ------
    ValueError
        If it is none, or empty.
    """
    if not isinstance(value, str) or not value:
        raise ValueError(f"{key} must be a text, got {value!r}")
    return value


def texts(value: Any, key: str) -> list[str]:
    """Check a list of file names, or one name with wild cards, or of a folder.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    list of str
        The names.

    Raises
    ------
    ValueError
        If it is none, or empty.
    """
    if isinstance(value, str) and value:
        return [value]
    if not isinstance(value, list) or not value or not all(isinstance(v, str) and v for v in value):
        raise ValueError(f'{key} must be a list of file names, ["1.obj", ...], got {value!r}')
    return value


def flag(value: Any, key: str) -> bool:
    """Check a truth value.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    bool
        The value.

    Raises
    ------
    ValueError
        If it is none.
    """
    if not isinstance(value, bool):
        raise ValueError(f"{key} must be true or false, got {value!r}")
    return value


def scale(value: Any, key: str) -> float | str:
    """Check how many times as far something travels.

    Parameters
    ----------
    value : object
        From the file.
    key : str
        Its key.

    Returns
    -------
    float or str
        A number, or ``"size"``.

    Raises
    ------
    ValueError
        If it is neither.
    """
    return "size" if value == "size" else number(value, key)
