"""How far a leg reaches: displacements that would stretch it out of shape are limited."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_FREE, _MOST = 1.05, 1.08
"""Shares of its length to which a leg stretches freely, and which it never passes."""


def within_reach(hip: FloatArray, ankle: FloatArray, length: float, path: FloatArray) -> FloatArray:
    """Limit the displacement of a foot to what its leg reaches.

    Parameters
    ----------
    hip, ankle : (T, 3) float
        Joints in frames without the displacement, metres.
    length : float
        Metres from hip to ankle of the straight leg.
    path : (T, 3) float
        Displacement wanted, metres.

    Returns
    -------
    (T, 3) ndarray
        The displacement itself wherever the leg stays shorter than 1.05 of its length, or no longer than it
        was; beyond, the foot is drawn back along the leg, smoothly, and the leg stays below 1.08.
    """
    now, then = ankle - hip, ankle + path - hip
    was, wanted = np.linalg.norm(now, axis=1), np.linalg.norm(then, axis=1)
    free = np.maximum(_FREE * length, was)
    room = (_MOST - _FREE) * length
    over = np.maximum(wanted - free, 0.0)
    allowed = np.where(over > 0, free + room * -np.expm1(-over / room), wanted)
    scale = np.divide(allowed, wanted, out=np.ones_like(wanted), where=wanted > 0)
    return then * scale[:, None] - now
