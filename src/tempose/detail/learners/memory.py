"""Looking back in time: how far, and never into another clip."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray, IntArray

_LAGS_PER_SECOND = 30


def lags_at(lags: tuple[int, ...], fps: float) -> tuple[int, ...]:
    """Turn times into frames.

    Parameters
    ----------
    lags : tuple of int
        Thirtieths of a second, ascending.
    fps : float
        Frames per second.

    Returns
    -------
    tuple of int
        Frames, ascending; fewer where several fall on one.
    """
    return tuple(sorted({round(lag * fps / _LAGS_PER_SECOND) for lag in lags}))


def frames_remembered(predictor: object) -> int:
    """Count the frames that a predictor looks back to.

    Parameters
    ----------
    predictor : object
        A fitted learner.

    Returns
    -------
    int
        Frames of the training; 0 for one that looks at velocities of the frame alone.
    """
    return max(getattr(getattr(predictor, "features", None), "lags", (0,)))


def past(values: FloatArray, chains: IntArray, lag: int) -> FloatArray:
    """Look back in time, never into another clip.

    Parameters
    ----------
    values : (T, ...) float
        A value a frame.
    chains : (T,) int
        Which clip every frame is from.
    lag : int
        Frames back; where the clip is not so old its first frame answers.

    Returns
    -------
    (T, ...) ndarray
        Earlier values.
    """
    ages = frame_ages(chains)
    return values[np.arange(len(chains)) - np.minimum(ages, lag)]


def frame_ages(chains: IntArray) -> IntArray:
    """Count the frames of the same clip before each.

    Parameters
    ----------
    chains : (T,) int
        Which clip every frame is from.

    Returns
    -------
    (T,) ndarray
        Frames before it.
    """
    frames = np.arange(len(chains))
    begins = np.diff(chains, prepend=chains[:1] - 1) != 0
    return frames - np.maximum.accumulate(np.where(begins, frames, 0))
