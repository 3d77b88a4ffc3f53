"""Axis and unit conversion at the border: inside everything is metres, Y up, +Z front."""

from __future__ import annotations

import math

import numpy as np

from tempose.typing import FloatArray

_TO_Y_UP = {
    "y": np.eye(3),
    "z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "x": np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]),
}

UNITS = {"mm": 1e-3, "cm": 1e-2, "dm": 1e-1, "m": 1.0, "in": 0.0254, "ft": 0.3048, "cmu": 0.0254 / 0.45}
"""Metres per named unit; ``cmu`` is the unit of the CMU motion capture files."""


class FormatError(ValueError):
    """A file that cannot be read as what it claims to be; the message names file, place and expectation."""


def y_up_rotation(up: str) -> FloatArray:
    """Rotation from a file's axes to ours.

    Parameters
    ----------
    up : str
        Up axis of the file: ``"x"``, ``"y"`` or ``"z"``.

    Returns
    -------
    (3, 3) ndarray
        ``p_inside = R @ p_file``; Z up maps the file's front -Y to +Z.
    """
    return _TO_Y_UP[up]


def to_inside(points: FloatArray, up: str, unit: float) -> FloatArray:
    """Convert positions or offsets of a file to metres, Y up.

    Parameters
    ----------
    points : (..., 3) float
        As in the file.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.

    Returns
    -------
    (..., 3) ndarray
        Metres, Y up.
    """
    if up == "y":
        return np.asarray(points) * unit
    return np.asarray(points) @ y_up_rotation(up).T * unit


def to_file(points: FloatArray, up: str, unit: float) -> FloatArray:
    """Convert metres, Y up, to the axes and unit of a file: the inverse of `to_inside`.

    Parameters
    ----------
    points : (..., 3) float
        Metres, Y up.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.

    Returns
    -------
    (..., 3) ndarray
        As the file wants them.
    """
    if up == "y":
        return np.asarray(points) / unit
    return np.asarray(points) @ y_up_rotation(up) / unit


def guess_unit(height: float, names: tuple[str, ...] = ("mm", "cm", "dm", "m"), target: float = 1.7) -> float:
    """Guess the unit of a file that states none from the height of what is in it.

    Parameters
    ----------
    height : float
        Height in units of the file.
    names : tuple of str
        Candidate units, keys of `UNITS`.
    target : float, default 1.7
        Height in metres that is likely.

    Returns
    -------
    float
        Metres per unit: 1 if that gives 0.3 to 3 m, else the candidate that comes nearest to `target`.
    """
    if height <= 0 or (0.3 <= height <= 3.0 and "m" in names):
        return 1.0
    return min((UNITS[name] for name in names), key=lambda u: abs(math.log(height * u / target)))
