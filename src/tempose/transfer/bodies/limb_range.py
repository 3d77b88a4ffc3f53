"""How far a limb reaches: a limit that is approached smoothly and never passed."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

SOFT_FAR = 0.02
"""Share of full reach before it at which stretching begins to slow down."""
SOFT_NEAR = 0.05
"""Share of full reach above complete folding at which bending begins to slow down."""
_LEAST = 1e-12


def within_range(wanted: FloatArray, now: FloatArray, near: FloatArray, far: FloatArray) -> FloatArray:
    """Bring distances smoothly into the range of a limb.

    Parameters
    ----------
    wanted : (...) float
        Distance from the first joint at which the end shall be.
    now : (...) float
        Distance at which it is; between `near` and `far`.
    near, far : (...) float
        Distances when the limb is folded and when it is straight.

    Returns
    -------
    (...) ndarray
        Distances between `near` and `far`. What is wanted, except close to the limits; exactly `now` where
        that is wanted, however close to a limit it is.

    Notes
    -----
    With the slack ``x = (far - wanted) / far`` and a threshold ``x_a`` below both `SOFT_FAR` and the slack
    of now, slack below the threshold becomes ``x_a / (1 + y + y^2)``, ``y = (x_a - x) / x_a``, which joins
    the identity with two continuous derivatives. The same holds at `near`.
    """
    scale = np.maximum(far, _LEAST)
    reached = far - scale * _slack((far - wanted) / scale, (far - now) / scale, SOFT_FAR)
    return near + scale * _slack((reached - near) / scale, (now - near) / scale, SOFT_NEAR)


def _slack(x: FloatArray, now: FloatArray, soft: float) -> FloatArray:
    """Slack that stays positive; the threshold is a smooth minimum of `now` and `soft`."""
    now = np.maximum(now, _LEAST)
    threshold = now * soft / (now**4 + soft**4) ** 0.25
    y = np.maximum(1 - x / threshold, 0.0)
    return np.where(y > 0, threshold / (1 + y + y * y), x)
