"""Hamilton quaternions ``wxyz``: q and -q are the same rotation."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

IDENTITY: FloatArray = np.array([1.0, 0.0, 0.0, 0.0])
"""The rotation that moves nothing."""
IDENTITY.flags.writeable = False


def multiply(p: FloatArray, q: FloatArray) -> FloatArray:
    """Compose rotations: the result rotates by `q` first, then by `p`.

    Parameters
    ----------
    p, q : (..., 4) float
        Quaternions wxyz; leading axes broadcast.

    Returns
    -------
    (..., 4) ndarray
        Hamilton product ``p q``.

    Examples
    --------
    >>> multiply(np.array([0, 1.0, 0, 0]), np.array([0, 0, 1.0, 0])).tolist()
    [0.0, 0.0, 0.0, 1.0]
    """
    pw, px, py, pz = np.moveaxis(np.asarray(p, dtype=np.float64), -1, 0)
    qw, qx, qy, qz = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    return np.stack(
        [
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ],
        axis=-1,
    )


def conjugate(q: FloatArray) -> FloatArray:
    """Invert unit quaternions.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.

    Returns
    -------
    (..., 4) ndarray
        The inverse rotations.
    """
    return np.asarray(q) * np.array([1.0, -1.0, -1.0, -1.0])


def normalise(q: FloatArray) -> FloatArray:
    """Scale quaternions to unit length; a zero quaternion becomes the identity.

    Parameters
    ----------
    q : (..., 4) float
        Quaternions of any length.

    Returns
    -------
    (..., 4) ndarray
        Unit quaternions.
    """
    q = np.asarray(q, dtype=np.float64)
    length = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(length > 0, q / np.where(length > 0, length, 1.0), IDENTITY)


def rotate(q: FloatArray, x: FloatArray) -> FloatArray:
    """Rotate vectors.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.
    x : (..., 3) float
        Vectors; leading axes broadcast against those of `q`.

    Returns
    -------
    (..., 3) ndarray
        Rotated vectors.

    Examples
    --------
    >>> half_turn_about_z = np.array([0.0, 0, 0, 1])
    >>> rotate(half_turn_about_z, np.array([1.0, 2, 3])).tolist()
    [-1.0, -2.0, 3.0]
    """
    q = np.asarray(q, dtype=np.float64)
    w, v = q[..., :1], q[..., 1:]
    t = 2.0 * np.cross(v, x)
    return x + w * t + np.cross(v, t)


def to_matrix(q: FloatArray) -> FloatArray:
    """Convert unit quaternions to rotation matrices.

    Parameters
    ----------
    q : (..., 4) float
        Unit quaternions wxyz.

    Returns
    -------
    (..., 3, 3) ndarray
        Matrices that act on column vectors.
    """
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    rows = [
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    ]
    return np.stack(rows, axis=-1).reshape(*np.shape(w), 3, 3)


def from_matrix(R: FloatArray) -> FloatArray:
    """Convert rotation matrices to unit quaternions with ``w >= 0``.

    Parameters
    ----------
    R : (..., 3, 3) float
        Rotation matrices.

    Returns
    -------
    (..., 4) ndarray
        Quaternions wxyz.

    Notes
    -----
    Of the four equivalent formulas the one with the largest pivot is taken, so that no angle is special.
    """
    R = np.asarray(R, dtype=np.float64)
    r = R.reshape(-1, 9)
    d = r[:, [0, 4, 8]]
    pivots = np.column_stack([d.sum(1), d * 2 - d.sum(1, keepdims=True)])
    best = pivots.argmax(axis=1)
    a, b, c = r[:, 7] - r[:, 5], r[:, 2] - r[:, 6], r[:, 3] - r[:, 1]
    p, s, t = r[:, 3] + r[:, 1], r[:, 2] + r[:, 6], r[:, 7] + r[:, 5]
    one = 1 + pivots[np.arange(len(r)), best]
    rows = np.stack(
        [
            np.column_stack([one, a, b, c]),
            np.column_stack([a, one, p, s]),
            np.column_stack([b, p, one, t]),
            np.column_stack([c, s, t, one]),
        ]
    )
    q = normalise(rows[best, np.arange(len(r))])
    q = np.where(q[:, :1] < 0, -q, q)
    return q.reshape(*R.shape[:-2], 4)


def angle_between(p: FloatArray, q: FloatArray) -> FloatArray:
    """Angle of the rotation from `p` to `q`.

    Parameters
    ----------
    p, q : (..., 4) float
        Unit quaternions wxyz.

    Returns
    -------
    (...) ndarray
        Radians, 0 to pi; q and -q count as one.
    """
    relative = multiply(conjugate(p), q)
    return 2.0 * np.arctan2(np.linalg.norm(relative[..., 1:], axis=-1), np.abs(relative[..., 0]))


def slerp(p: FloatArray, q: FloatArray, s: FloatArray | float) -> FloatArray:
    """Interpolate at constant angular speed along the shorter way.

    Parameters
    ----------
    p, q : (..., 4) float
        Unit quaternions at ``s = 0`` and ``s = 1``.
    s : (...) float
        Where to evaluate.

    Returns
    -------
    (..., 4) ndarray
        Unit quaternions.
    """
    p, q = np.asarray(p, dtype=np.float64), np.asarray(q, dtype=np.float64)
    s = np.asarray(s, dtype=np.float64)[..., None]
    dot = np.sum(p * q, axis=-1, keepdims=True)
    q = np.where(dot < 0, -q, q)
    theta = (
        np.arctan2(
            np.linalg.norm(q - p, axis=-1, keepdims=True), np.linalg.norm(q + p, axis=-1, keepdims=True)
        )
        * 2.0
    )
    # np.sinc is sin(pi x) / (pi x): the ratio of sines without a special case at theta = 0
    scale = np.sinc(theta / np.pi)
    a = (1 - s) * np.sinc((1 - s) * theta / np.pi) / scale
    b = s * np.sinc(s * theta / np.pi) / scale
    return normalise(a * p + b * q)


def continuous(q: FloatArray) -> FloatArray:
    """Of q and -q, which are the same rotation, take the one nearer to the frame before.

    Parameters
    ----------
    q : (T, ..., 4) float
        Unit quaternions wxyz, frames first.

    Returns
    -------
    (T, ..., 4) ndarray
        The same rotations; the first frame is left as it is.

    Examples
    --------
    >>> continuous(np.array([[1.0, 0, 0, 0], [-0.8, -0.6, 0, 0], [0.6, 0.8, 0, 0]]))[:, :2].tolist()
    [[1.0, 0.0], [0.8, 0.6], [0.6, 0.8]]
    """
    q = np.asarray(q, dtype=np.float64)
    turned = np.where((q[1:] * q[:-1]).sum(axis=-1) < 0, -1.0, 1.0)
    signs = np.concatenate([np.ones((min(len(q), 1), *q.shape[1:-1])), np.cumprod(turned, axis=0)])
    return q * signs[..., None]
