"""Paths of least acceleration through hard constraints."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from tempose.typing import BoolArray, FloatArray

_SLACK = 1e-8
_ROUNDS = 12
_CHANGES = 60


def steady_path(C: Any, g: FloatArray, fade: float) -> FloatArray:
    """Find the path of least acceleration that meets linear conditions exactly.

    Parameters
    ----------
    C : (c, T) sparse array
        Conditions on the T frames.
    g : (c, k) float
        What they shall give, for each of k coordinates.
    fade : float
        Frames after which a displacement has faded once no condition asks for it; infinity for never.

    Returns
    -------
    (T, k) ndarray
        The path; zero where all of `g` is zero. Conditions that contradict each other are met in least
        squares.

    Notes
    -----
    Minimises ``sum |d''|^2 + |d|^2 / fade^4`` subject to ``C d = g``: between conditions a cubic spline that
    returns to zero. Its saddle-point system is made regular by a slack that shrinks from round to round.
    """
    return _solve(_energy(C.shape[1], fade), C, np.asarray(g, dtype=np.float64))[0]


def path_above(floor: FloatArray, fixed: BoolArray, fade: float) -> FloatArray:
    """Find the path of least acceleration that lies nowhere below a floor and on it in some frames.

    Parameters
    ----------
    floor : (T,) float
        Least value of every frame.
    fixed : (T,) bool
        Frames in which the path is on the floor.
    fade : float
        See `steady_path`.

    Returns
    -------
    (T,) ndarray
        The path; zero where it need not move.
    """
    floor = np.asarray(floor, dtype=np.float64)
    T = len(floor)
    size = float(np.abs(np.where(fixed, floor, np.maximum(floor, 0))).max(initial=0.0))
    if size == 0:
        return np.zeros(T)
    energy, level = _energy(T, fade), floor / size
    tight = np.zeros(T, dtype=bool)
    d = np.zeros(T)
    for _ in range(_CHANGES):
        held = np.flatnonzero(fixed | tight)
        C = sp.csr_array((np.ones(len(held)), (np.arange(len(held)), held)), shape=(len(held), T))
        path, pull = _solve(energy, C, level[held, None])
        d = path[:, 0]
        pulled = np.zeros(T)
        pulled[held] = pull[:, 0]
        below = (d < level - 1e-9) & ~fixed & ~tight
        # a frame that the floor would have to hold down is free again
        loose = tight & (pulled > 1e-12)
        if not below.any() and not loose.any():
            break
        tight = (tight & ~loose) | below
    return size * np.where(fixed, level, np.maximum(d, level))


def _energy(T: int, fade: float) -> Any:
    bend = second_differences(T)
    rest = 0.0 if np.isinf(fade) else fade**-4.0
    return bend.T @ bend + sp.eye_array(T) * max(rest, 1e-12)


def second_differences(T: int) -> Any:
    """Matrix of second differences of T frames.

    Parameters
    ----------
    T : int
        Number of frames.

    Returns
    -------
    (T - 2, T) sparse array
        Without rows where there are fewer than three frames.
    """
    if T < 3:
        return sp.csr_array((0, T))
    row = np.repeat(np.arange(T - 2), 3)
    parts = (np.tile([1.0, -2.0, 1.0], T - 2), (row, row + np.tile([0, 1, 2], T - 2)))
    return sp.csr_array(parts, shape=(T - 2, T))


def _solve(energy: Any, C: Any, g: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return path and multipliers; a multiplier is positive where the condition pulls down."""
    c, T = C.shape
    if c == 0:
        return np.zeros((T, g.shape[1])), np.zeros((0, g.shape[1]))
    factor = splu(sp.csc_array(sp.block_array([[energy, C.T], [C, -_SLACK * sp.eye_array(c)]])))
    d, pull = np.zeros((T, g.shape[1])), np.zeros(g.shape)
    size = float(np.abs(g).max())
    for _ in range(_ROUNDS):
        both = factor.solve(np.concatenate([np.zeros((T, g.shape[1])), g - _SLACK * pull]))
        d, pull = both[:T], both[T:]
        if np.abs(C @ d - g).max() <= 1e-13 * size:
            break
    return d, pull
