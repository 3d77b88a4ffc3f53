"""What is said after --strength and --mask."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from tempose.typing import FloatArray


def parse_strength(words: list[str] | None) -> float | dict[str, float]:
    """Read what was said after --strength.

    Parameters
    ----------
    words : list of str, optional
        ``S`` or ``JOINT=S`` each.

    Returns
    -------
    float or dict of str to float
        One number for all, or by joint, the others as learned.

    Raises
    ------
    ValueError
        If one is written otherwise, is negative or said twice.
    """
    whole: float | None = None
    parts: dict[str, float] = {}
    for word in words or []:
        name, equals, number = word.rpartition("=")
        value = _number(word, number)
        if equals:
            if name in parts:
                raise ValueError(f"--strength names {name!r} twice")
            parts[name] = value
        elif whole is not None:
            raise ValueError("--strength is said twice for the whole body; name joints, as in left_shin=0.5")
        else:
            whole = value
    if whole is not None and parts:
        raise ValueError("--strength must be one number, or numbers by joint, not both")
    return parts or (1.0 if whole is None else whole)


def _number(word: str, number: str) -> float:
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not 0 <= value < math.inf:
        raise ValueError(f"--strength must be a number from 0, or JOINT=NUMBER, got {word!r}")
    return value


def read_mask(word: str | None) -> FloatArray | list[str] | None:
    """Read what was said after --mask.

    Parameters
    ----------
    word : str, optional
        A file or names of joints between commas.

    Returns
    -------
    (n,) ndarray, list of str or None
        A number for each vertex, names, or nothing.

    Raises
    ------
    ValueError
        If the file holds anything but numbers from 0 to 1.
    """
    if word is None:
        return None
    path = Path(word)
    if path.suffix.lower() not in (".npy", ".json"):
        names = [name.strip() for name in word.split(",")]
        if not all(names):
            raise ValueError(f"--mask must be joints between commas, or a .npy or .json file, got {word!r}")
        return names
    values = _values(path)
    if values.ndim != 1 or not np.isfinite(values).all() or (values < 0).any() or (values > 1).any():
        raise ValueError(f"{path}: expected one number from 0 to 1 for each vertex")
    return values


def _values(path: Path) -> FloatArray:
    import json

    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    try:
        if path.suffix.lower() == ".npy":
            found: Any = np.load(path, allow_pickle=False)
        else:
            found = json.loads(path.read_text(encoding="utf-8-sig"))
        return np.asarray(found, dtype=np.float64)
    except (ValueError, TypeError, EOFError, RecursionError):
        raise ValueError(f"{path}: expected a list of numbers, one for each vertex") from None
