"""How many shape modes, sites and control points a tolerance asks for (section 3.4 of the paper)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tempose.typing import FloatArray, Progress, silent

SHAPE_SHARE = 0.75
"""Part of the tolerance that the shape signal may use up: a mode costs d numbers, a site or control a few."""

POSE_SHARE = 0.92
"""Part that shape and pose signal may use up together; the time signal needs the rest."""

COARSE = 200
"""Longer clips than so many frames are scanned in larger steps."""


def choose_sites(errors: FloatArray, left_out: float, limit: float) -> int:
    """Choose l: the smallest number of sites with which shape and pose signal meet a limit together.

    Parameters
    ----------
    errors : (n + 1,) float
        Squared residual of g for every number of sites.
    left_out : float
        Squared residual of h; the two add up, since they are orthogonal.
    limit : float
        Largest squared sum.

    Returns
    -------
    int
        From 3 on; the one with the least error where none meets the limit.
    """
    errors = np.asarray(errors, dtype=np.float64)
    low = min(3, len(errors) - 1)
    meets = np.flatnonzero(errors[low:] + left_out <= limit)
    return low + int(meets[0] if len(meets) else np.argmin(errors[low:]))


def choose_controls(
    error: Callable[[int], float], T: int, limit: float, progress: Progress = silent
) -> tuple[int, bool]:
    """Choose k: the smallest number of control points such that every larger number meets a limit too.

    The error does not fall evenly with k (two steps in five it rises, on some clips), so neither bisection
    nor the first k that meets the limit is to be trusted.

    Parameters
    ----------
    error : callable
        Squared error of the whole for a number of controls.
    T : int
        Frames of the clip; k goes from T + 2 down.
    limit : float
        Largest squared sum.
    progress : Progress, optional
        Told how many numbers were tried.

    Returns
    -------
    k : int
        From 4 to T + 2.
    met : bool
        Whether T + 2 itself meets the limit.
    """
    step = max(1, T // COARSE)
    tried = [T + 2, *range(T + 2 - step, 4, -step), 4]
    chosen, met = T + 2, False
    for i, k in enumerate(tried):
        progress(i, len(tried), "choosing the number of control points")
        if error(k) > limit:
            break
        chosen, met = k, True
    return chosen, met
