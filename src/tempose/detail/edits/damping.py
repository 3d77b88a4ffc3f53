"""Detail made calmer: what changes faster than a time is smoothed away, what lasts stays."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_REACH = 4.0
"""Standard deviations after which the bell is cut off."""


def damped(C: FloatArray, seconds: float, fps: float) -> FloatArray:
    """Smooth coefficients over time by a bell that looks as far ahead as back, so that nothing lags.

    Parameters
    ----------
    C : (T, ...) float
        Coefficients of every frame.
    seconds : float
        Standard deviation of the bell.
    fps : float
        Frames per second.

    Returns
    -------
    (T, ...) ndarray
        Smoothed; a constant stays as it is. At the ends the bell is cut and the rest weighs more.

    Raises
    ------
    ValueError
        If `seconds` is negative or not finite.
    """
    if not 0 <= seconds < np.inf:
        raise ValueError(f"damp must be 0 seconds or more, got {seconds}")
    width = seconds * fps
    T = len(C)
    reach = min(int(np.ceil(_REACH * width)), T - 1)
    if reach < 1 or width < 1e-3:
        return np.array(C)
    total, weight = np.zeros(C.shape), np.zeros(T)
    for k in range(-reach, reach + 1):
        bell = float(np.exp(-0.5 * (k / width) ** 2))
        here, there = slice(max(0, -k), T - max(0, k)), slice(max(0, k), T - max(0, -k))
        total[here] += bell * C[there]
        weight[here] += bell
    return total / weight.reshape(-1, *[1] * (C.ndim - 1))
