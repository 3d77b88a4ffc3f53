"""Checks and loops over leading axes that both spaces of edges share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tempose.typing import FloatArray


def check_meshes(V: Any, n: int) -> FloatArray:
    """Check vertices of one mesh or many.

    Parameters
    ----------
    V : (..., n, 3) float
        What the caller gave.
    n : int
        Number of vertices.

    Returns
    -------
    (..., n, 3) ndarray of float64
        Finite.

    Raises
    ------
    ValueError
        If the shape is another or a value is not finite.
    """
    return _checked(V, "V", (n, 3))


def check_coordinates(z: Any, d: int) -> FloatArray:
    """Check coordinates of one mesh or many.

    Parameters
    ----------
    z : (..., d) float
        What the caller gave.
    d : int
        Dimension of the space.

    Returns
    -------
    (..., d) ndarray of float64
        Finite.

    Raises
    ------
    ValueError
        If the shape is another or a value is not finite.
    """
    return _checked(z, "z", (d,))


def _checked(value: Any, name: str, tail: tuple[int, ...]) -> FloatArray:
    array = np.asarray(value, dtype=np.float64)
    if array.shape[-len(tail) :] != tail or array.ndim < len(tail):
        wanted = ", ".join(["...", *(str(k) for k in tail)])
        raise ValueError(f"{name} must have shape ({wanted}), got {array.shape}")
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name} must be finite, got {array[where]} at index {where}")
    return array


def over_rows(
    function: Callable[[FloatArray], FloatArray], rows: FloatArray, tail: int, shape: tuple[int, ...]
) -> FloatArray:
    """Apply a function to each mesh or vector of a batch.

    Parameters
    ----------
    function : callable
        Takes one, gives an array of `shape`.
    rows : (..., *one) float
        The batch.
    tail : int
        Number of axes of one.
    shape : tuple of int
        Shape of what the function gives.

    Returns
    -------
    (..., *shape) ndarray
        All results.
    """
    lead = rows.shape[: rows.ndim - tail]
    flat = rows.reshape(-1, *rows.shape[rows.ndim - tail :])
    out = np.zeros((len(flat), *shape))
    for k, row in enumerate(flat):
        out[k] = function(row)
    return out.reshape(*lead, *shape)
