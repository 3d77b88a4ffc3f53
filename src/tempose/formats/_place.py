"""What a mesh in a file's own axes and unit becomes inside, and back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.clips import Mesh, Source
from tempose.formats.conventions import UNITS, FormatError, guess_unit, to_file, to_inside
from tempose.typing import FloatArray

DEFAULT_FPS = 30.0
"""Frames per second assumed where a file states none."""


def metres_per_unit(unit: str | float | None) -> float | None:
    """Read a unit given by a person.

    Parameters
    ----------
    unit : str, float or None
        A name of `tempose.formats.conventions.UNITS`, or metres per unit.

    Returns
    -------
    float or None
        Metres per unit; None stays None.

    Raises
    ------
    ValueError
        If the name is unknown or the number not positive.

    Examples
    --------
    >>> metres_per_unit("cm")
    0.01
    """
    if unit is None:
        return None
    try:
        value = UNITS[unit] if isinstance(unit, str) and unit in UNITS else float(unit)
    except (TypeError, ValueError):
        value = 0.0
    if not 0 < value < float("inf"):
        raise ValueError(f"unit must be one of {', '.join(UNITS)} or metres per unit, got {unit!r}")
    return value


def check_up(up: str | None) -> None:
    """Refuse an up axis that is none.

    Parameters
    ----------
    up : str or None
        ``"x"``, ``"y"``, ``"z"`` or None.

    Raises
    ------
    ValueError
        If it is anything else.
    """
    if up not in (None, "x", "y", "z"):
        raise ValueError(f"up must be x, y or z, got {up!r}")


def settle(
    mesh: Mesh, path: str, format: str, up: str | None, unit: str | float | None, notes: tuple[str, ...] = ()
) -> Mesh:
    """Bring a mesh as read from a file that states no axes and no unit inside.

    Parameters
    ----------
    mesh : Mesh
        Vertices in the axes and unit of the file.
    path : str
        Where it came from.
    format : str
        Short name of the format.
    up : str or None
        Up axis if the user states it; None assumes Y.
    unit : str, float or None
        Unit if the user states it; None guesses from the height.
    notes : tuple of str
        What was unusual about the file.

    Returns
    -------
    Mesh
        Metres, Y up, with its `Source`.
    """
    check_up(up)
    metres = metres_per_unit(unit)
    guessed = tuple(k for k, v in (("up", up), ("unit", metres)) if v is None)
    up = up or "y"
    if metres is None:
        column = mesh.vertices[:, "xyz".index(up)]
        metres = guess_unit(float(np.ptp(column))) if len(column) else 1.0
    source = Source(path, format, up, metres, None, guessed, notes)
    return replace(mesh, vertices=inside(mesh.vertices, source, path), source=source)


def inside(V: FloatArray, source: Source, path: str) -> FloatArray:
    """Convert positions of a file to metres, Y up.

    Parameters
    ----------
    V : (..., 3) float
        As in the file.
    source : Source
        Axes and unit.
    path : str
        File to name when a value is too large to be held.

    Returns
    -------
    (..., 3) ndarray of float64
        Metres, Y up.

    Raises
    ------
    FormatError
        If a coordinate does not fit a 32-bit float, which frames are kept in.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        result = to_inside(np.asarray(V, dtype=np.float64), source.up, source.unit)
    if result.size and not np.abs(result).max() < 1e30:
        worst = float(np.abs(V).max())
        raise FormatError(f"{path}: expected coordinates below 1e30 m, found {worst:.4g}")
    return result


def outside(V: FloatArray, up: str, unit: float) -> FloatArray:
    """Convert positions back; what `inside` made of a file's numbers comes in again as the same.

    Parameters
    ----------
    V : (..., 3) float
        Metres, Y up.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.

    Returns
    -------
    (..., 3) ndarray of float64
        As the file wants them.
    """
    return to_file(np.asarray(V, dtype=np.float64), up, unit)
