"""Rotations that carry one set of vectors onto another as well as they can."""

from __future__ import annotations

import numpy as np

from tempose.rotations.average import mean_weights
from tempose.rotations.quaternions import normalise
from tempose.typing import FloatArray


def shortest_rotation(a: FloatArray, b: FloatArray) -> FloatArray:
    """Rotation by the smallest angle that takes direction `a` to direction `b`.

    Parameters
    ----------
    a, b : (..., 3) float
        Directions, need not have unit length; a zero vector gives the identity.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz. For opposite directions some axis perpendicular to `a` is taken.
    """
    a, b = _unit(a), _unit(b)
    a, b = np.broadcast_arrays(a, b)
    # through a + b, not 1 + a.b: that loses all digits of the angle when a and b are nearly opposite
    middle = a + b
    w = 0.5 * np.sum(middle * middle, axis=-1, keepdims=True)
    q = np.concatenate([w, np.cross(a, middle)], axis=-1)
    # opposite: any axis perpendicular to a, made from the coordinate axis least along a
    other = np.eye(3)[np.abs(a).argmin(axis=-1)]
    half_turn = np.concatenate([np.zeros_like(w), np.cross(a, other)], axis=-1)
    return normalise(np.where(w > 1e-29, q, half_turn))


def _unit(x: FloatArray) -> FloatArray:
    x = np.asarray(x, dtype=np.float64)
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    return x / np.where(length > 0, length, 1.0)


def polar_rotation(A: FloatArray) -> FloatArray:
    """Rotation factor of the polar decomposition, the rotation nearest to a matrix.

    Parameters
    ----------
    A : (..., 3, 3) float
        Any matrices.

    Returns
    -------
    (..., 3, 3) ndarray
        Rotations (determinant +1); for a reflection the weakest axis is flipped.
    """
    U, _, Vt = np.linalg.svd(np.asarray(A, dtype=np.float64))
    sign = np.where(np.linalg.det(U @ Vt) < 0, -1.0, 1.0)
    U[..., :, 2] *= sign[..., None]
    return U @ Vt


def procrustes_rotation(P: FloatArray, Q: FloatArray, weights: FloatArray | None = None) -> FloatArray:
    """Rotation R that brings centred points `P` nearest to centred `Q` (Kabsch).

    Parameters
    ----------
    P, Q : (..., k, 3) float
        Corresponding points.
    weights : (k,) float, optional
        Weight of each pair, not negative, not all zero.

    Returns
    -------
    (..., 3, 3) ndarray
        ``R`` minimising ``sum w |R (p - mean p) - (q - mean q)|^2``.

    Raises
    ------
    ValueError
        If there is no point, or the weights cannot be weights.
    """
    P, Q = np.asarray(P, dtype=np.float64), np.asarray(Q, dtype=np.float64)
    w = mean_weights(weights, P.shape[-2])
    P0 = P - np.einsum("k,...ki->...i", w, P)[..., None, :]
    Q0 = Q - np.einsum("k,...ki->...i", w, Q)[..., None, :]
    return polar_rotation(np.einsum("k,...ki,...kj->...ij", w, Q0, P0))
