"""Rotations from the angles that files hold, and the exponential map."""

from __future__ import annotations

import numpy as np

from tempose.rotations.quaternions import multiply, to_matrix
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


def to_euler_degrees(q: FloatArray, order: str) -> FloatArray:
    """Angles about three moving axes: the inverse of `from_euler_degrees`.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.
    order : str
        Three different letters out of ``"xyz"``, first one outermost.

    Returns
    -------
    (..., 3) ndarray
        Degrees: the first and the last from -180 to 180, the middle one from -90 to 90. Where the middle
        one is 90 degrees only a sum of the others is determined, and the first is 0.

    Raises
    ------
    ValueError
        If `order` is anything else.

    Examples
    --------
    >>> to_euler_degrees(from_euler_degrees(np.array([10.0, 20, 30]), "zxy"), "zxy").round(9).tolist()
    [10.0, 20.0, 30.0]
    """
    if sorted(order.lower()) != ["x", "y", "z"]:
        raise ValueError(f"order must be the letters x, y and z in some order, got {order!r}")
    i, j, k = ("xyz".index(letter) for letter in order.lower())
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    R = to_matrix(q)
    flat = np.hypot(R[..., j, k], R[..., k, k]) < 1e-13
    first = np.where(flat, 0.0, np.arctan2(-sign * R[..., j, k], R[..., k, k]))
    # what is left after the first turn is taken back is exact also where the middle one is near 90 degrees
    c, s = np.cos(first)[..., None], sign * np.sin(first)[..., None]
    row_j, row_k = c * R[..., j, :] + s * R[..., k, :], c * R[..., k, :] - s * R[..., j, :]
    middle = np.arctan2(sign * R[..., i, k], row_k[..., k])
    last = np.arctan2(sign * row_j[..., i], row_j[..., j])
    return np.degrees(np.stack([first, middle, last], axis=-1))
