"""Frame rate of an animation: glTF has none, so the spacing of its keys must tell."""

from __future__ import annotations

import numpy as np

from tempose.formats.glb_json import Item
from tempose.typing import FloatArray


def stated_rate(animation: Item, keys: FloatArray) -> float | None:
    """Rate that our own writer left in the extras, if the keys agree with it.

    Parameters
    ----------
    animation : Item
        The animation.
    keys : (k,) float
        Rising seconds.

    Returns
    -------
    float or None
        Frames per second.
    """
    extras = animation.fields.get("extras")
    ours = extras.get("tempose") if isinstance(extras, dict) else None
    stated = ours.get("fps") if isinstance(ours, dict) else None
    if not isinstance(stated, float | int) or not 0 < stated <= 1e4:
        return None
    steps = (keys - keys[0]) * stated
    # float32 keys: what rounding leaves grows with time
    slack = 1e-3 + 1e-6 * np.abs(keys) * stated
    return float(stated) if (np.abs(steps - np.rint(steps)) < slack).all() else None


def key_rate(keys: FloatArray) -> tuple[float | None, bool]:
    """Frame rate from the spacing of key times.

    Parameters
    ----------
    keys : (k,) float
        Rising seconds.

    Returns
    -------
    rate : float or None
        None if fewer than nine in ten gaps are whole multiples of the usual gap, or the rate is no frame
        rate.
    even : bool
        Whether all gaps are.

    Examples
    --------
    >>> key_rate(np.float32([0, 1 / 24, 2 / 24, 5 / 24]).astype(float))
    (24.0, True)
    """
    # channels may differ by rounding in what is meant to be one time
    keys = keys[np.diff(keys, prepend=-np.inf) > 1e-4]
    gaps = np.diff(keys)
    if not len(gaps):
        return None, False
    usual = float(np.median(gaps))
    steps = np.rint(gaps / usual)
    fits = (np.abs(gaps / usual - steps) < 0.01 * np.maximum(steps, 1.0)) & (steps > 0)
    if fits.mean() < 0.9 or not 9.5 < 1.0 / usual < 1010.0:
        return None, False
    rate = float(steps[fits].sum() / gaps[fits].sum())
    whole, span = round(rate), float(keys[-1] - keys[0])
    # a whole rate is meant if it keeps step to the end of the clip
    if abs(span * (rate - whole)) < 1e-3:
        rate = float(whole)
    return rate, bool(fits.all())
