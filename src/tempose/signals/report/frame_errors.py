"""The error of every frame, signal by signal, and what h would leave out with fewer or more modes."""

from __future__ import annotations

import numpy as np

from tempose.signals.fit.clip import FittedClip
from tempose.signals.shape.fit import FittedShape
from tempose.typing import FloatArray


def frame_errors(fitted: FittedClip, played: FloatArray) -> dict[str, list[float]]:
    """Measure the error of every frame.

    Parameters
    ----------
    fitted : FittedClip
        Signals of a clip of T frames.
    played : (T,) float
        Mean squared distance of each frame to what is played, square metres.

    Returns
    -------
    dict of str to list of T floats
        Rms percent of the diagonal: ``h`` of the shape signal alone, ``hg`` of ``h(g(P))``, ``hgf`` of
        ``h(g(f(t)))``, and ``played``, measured at the vertices. The mean square of a row over the frames
        is the square of its entry in the budget.
    """
    shape, signals, T = fitted.shape, fitted.signals, len(played)
    ticks = np.arange(T, dtype=np.float64)
    off = shape.X - signals.pose(signals.time(ticks), ticks)
    on_curve = np.square(off if shape.turn is None else off @ shape.turn).sum(axis=1)
    squares = {
        "h": shape.left_out,
        "hg": shape.left_out + fitted.pose_left_out,
        "hgf": shape.left_out + on_curve,
    }
    rows = {name: shape.percent(T * value).tolist() for name, value in squares.items()}
    return {**rows, "played": (100 / fitted.diagonal * np.sqrt(played)).tolist()}


def scree(shape: FittedShape) -> list[float]:
    """Return what the shape signal leaves out, for every number of modes.

    Parameters
    ----------
    shape : FittedShape
        A fitted shape signal.

    Returns
    -------
    list of r + 1 floats
        Rms percent of the diagonal with 0, 1, 2... principal components.
    """
    s2 = np.square(shape.spectrum)
    return [*shape.percent(np.cumsum(s2[::-1])[::-1]).tolist(), 0.0]
