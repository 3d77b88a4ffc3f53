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
    """Return knots with about as many parameters between any two (Piegl and Tiller, section 9.4.1).

    Parameters
    ----------
    t : (n,) float
        Ascending parameters.
    k : int
        Controls, 4 to n + 2.

    Returns
    -------
    (k + 4,) ndarray
        Knots, the ends fourfold; the inner knot j is t at index j d, linearly between two.

    Notes
    -----
    ``d = (n - 1) / (k - 3)``. The d of equations 9.68 and 9.69 makes some fits singular for k near n and does
    not give the parameters themselves at k = n + 2, which section 3.2.3 of Cashman and Hormann needs.
    """
    d = (len(t) - 1) / (k - 3)
    inner = np.interp(np.arange(1, k - 3) * d, np.arange(len(t)), t)
    return np.concatenate([[t[0]] * 4, inner, [t[-1]] * 4])
