"""Turns and twists through a clip, without jumps however far they go."""

from __future__ import annotations

import numpy as np

from tempose.typing import BoolArray, FloatArray

BLIND = 0.2
"""Below this length of the twist part (a swing of over 157 degrees) the twist is not defined."""
_STILL = 1e-3


def twist_angles(q: FloatArray, axis: FloatArray) -> FloatArray:
    """Angle by which rotations turn about an axis, followed through time.

    Parameters
    ----------
    q : (T, 4) float
        Unit quaternions wxyz, signs continuous in time.
    axis : (3,) float
        Unit axis.

    Returns
    -------
    (T,) ndarray
        Radians, of any size: a hand turned twice round ends at 4 pi. Where the swing is near a half turn,
        the twist is filled in from the frames round it.

    Notes
    -----
    A quaternion and its negative differ by a full turn, so that angles are unwrapped by 4 pi.
    """
    w, p = q[:, 0], q[:, 1:] @ axis
    seen = np.hypot(w, p) > BLIND
    return _followed(2 * np.arctan2(p, w), seen)


def continuous_vectors(q: FloatArray) -> FloatArray:
    """Logarithms of rotations, followed through time beyond a full turn.

    Parameters
    ----------
    q : (T, 4) float
        Unit quaternions wxyz, signs continuous in time.

    Returns
    -------
    (T, 3) ndarray
        Rotation vectors whose exponentials are the rotations. Their axis never flips between frames; near a
        full turn, where any axis will do, it is that of the frame before.
    """
    v = q[:, 1:]
    sine = np.linalg.norm(v, axis=1)
    seen = sine > _STILL
    small = 2 * v * np.where(q[:, :1] < 0, -1.0, 1.0)
    if not seen.any():
        return small
    axes = v[seen] / sine[seen, None]
    steps = np.where(np.sum(axes[1:] * axes[:-1], axis=1) < 0, -1.0, 1.0)
    axes = axes * np.cumprod(np.r_[1.0, steps])[:, None]
    axes = axes[np.maximum(np.cumsum(seen) - 1, 0)]
    angles = _followed(2 * np.arctan2(np.sum(v * axes, axis=1), q[:, 0]), np.ones(len(q), dtype=bool))
    unturned = np.logical_and(~seen, np.abs(angles) < np.pi)
    return np.where(unturned[:, None], small, angles[:, None] * axes)


def _followed(angles: FloatArray, seen: BoolArray) -> FloatArray:
    """Unwrap the frames that are seen and fill the others in."""
    frames = np.arange(len(angles))
    if not seen.any():
        return np.zeros(len(angles))
    return np.interp(frames, frames[seen], np.unwrap(angles[seen], period=4 * np.pi))
