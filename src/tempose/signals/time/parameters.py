"""Where along the curve the frames lie, and where the knots are put between them."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_FLOOR = 1e-3  # of the mean interval: a pose held would else let knots fall together


def centripetal_parameters(P: FloatArray) -> FloatArray:
    """Return parameters whose steps are the square roots of the distances (Lee 1989).

    Parameters
    ----------
    P : (n, 2) float
        Places of the frames in the pose plane, n >= 2.

    Returns
    -------
    (n,) ndarray
        Ascending from 0; no step is less than a thousandth of the mean one.
    """
    steps = np.sqrt(np.linalg.norm(np.diff(P, axis=0), axis=1))
    mean = steps.mean()
    steps = np.maximum(steps, _FLOOR * mean) if mean > 0 else np.ones(len(steps))
    return np.concatenate([[0.0], np.cumsum(steps)])


def averaged_knots(t: FloatArray, k: int) -> FloatArray:
    """Return knots with about as many parameters between any two, so that a fit is well determined.

    Parameters
    ----------
    t : (n,) float
        Ascending parameters.
    k : int
        Controls, 4 to n.

    Returns
    -------
    (k + 4,) ndarray
        Knots, the ends fourfold; the inner knot j = 1 .. k - 4 is t at index ``(j + 1) (n - 1) / (k - 1)``,
        linearly between two.

    Notes
    -----
    In the spirit of Piegl and Tiller, section 9.4.1, but neither with their d (some fits are singular for k
    near n) nor at ``j (n - 1) / (k - 3)``, which is never singular but as ill-conditioned as 1e15 at
    n = k = 204: the controls drift by one frame against the frames. Here controls lie evenly among the
    frames, as in a spline without knots next to the ends, and the condition stays below a hundred.
    """
    inner = np.interp(np.arange(2, k - 2) * ((len(t) - 1) / (k - 1)), np.arange(len(t)), t)
    return np.concatenate([[t[0]] * 4, inner, [t[-1]] * 4])
