"""Rotations from the angles that files hold, and the exponential map."""

from __future__ import annotations

import numpy as np

from tempose.rotations.quaternions import multiply
from tempose.typing import FloatArray


def from_rotation_vector(v: FloatArray) -> FloatArray:
    """Exponential map: axis times angle to unit quaternion.

    Parameters
    ----------
    v : (..., 3) float
        Axis times angle, radians.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz.
    """
    v = np.asarray(v, dtype=np.float64)
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle / 2), 0.5 * np.sinc(angle / (2 * np.pi)) * v], axis=-1)


def to_rotation_vector(q: FloatArray) -> FloatArray:
    """Logarithm of unit quaternions, the shorter way.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.

    Returns
    -------
    (..., 3) ndarray
        Axis times angle, radians, of length at most pi.
    """
    q = np.asarray(q, dtype=np.float64)
    q = np.where(q[..., :1] < 0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., :1])
    small = sine < 1e-12
    return q[..., 1:] * np.where(small, 2.0, angle / np.where(small, 1.0, sine))


def from_euler_degrees(angles: FloatArray, order: str) -> FloatArray:
    """Compose rotations about moving axes, first letter outermost, as BVH channels mean it.

    Parameters
    ----------
    angles : (..., k) float
        Degrees, one a letter.
    order : str
        k letters out of ``"xyz"``; ``"zxy"`` gives ``Rz Rx Ry``.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz.

    Raises
    ------
    ValueError
        If `order` holds another letter, or there is not one angle a letter.

    Examples
    --------
    >>> np.round(from_euler_degrees(np.array([90.0]), "z"), 6).tolist()
    [0.707107, 0.0, 0.0, 0.707107]
    """
    angles = np.asarray(angles, dtype=np.float64)
    if not set(order.lower()) <= set("xyz"):
        raise ValueError(f"order must be letters out of 'xyz', got {order!r}")
    if angles.ndim == 0 or angles.shape[-1] != len(order):
        raise ValueError(
            f"angles must have one column for each letter of {order!r}, got shape {angles.shape}"
        )
    half = np.radians(angles) / 2
    q = np.broadcast_to(np.array([1.0, 0, 0, 0]), (*half.shape[:-1], 4))
    for k, letter in enumerate(order.lower()):
        step = np.zeros((*half.shape[:-1], 4))
        step[..., 0] = np.cos(half[..., k])
        step[..., 1 + "xyz".index(letter)] = np.sin(half[..., k])
        q = multiply(q, step)
    return q
