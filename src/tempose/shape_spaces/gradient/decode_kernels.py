"""From rotation and stretch of every face to the right-hand side of the Poisson equation."""

from __future__ import annotations

import math
from typing import Any

import numba

from tempose.linalg.lanes import alike, item, load4, scaled, store
from tempose.shape_spaces.gradient.lanes import floor, polynomial, root, transposed
from tempose.shape_spaces.gradient.polynomials import COSINE, SINE

TILE = 64
"""Faces that are deformed for all vectors before the next; a multiple of 4."""
_PI_LOW = 1.2246467991473532e-16  # pi less what a double holds of it


@numba.njit(cache=True, nogil=True, inline="always")
def _quaternion(x: Any, y: Any, z: Any) -> Any:
    """Turn rotation vectors of any length into unit quaternions, up to their sign."""
    angle = root(x * x + y * y + z * z + alike(x, 1e-300))
    turns = floor(scaled(0.5 / math.pi, angle) + alike(x, 0.5))
    # half the angle less half turns: the quaternion only changes its sign
    r = scaled(0.5, angle) - scaled(math.pi, turns) - scaled(_PI_LOW, turns)
    u = r * r
    k = polynomial(SINE, u) * r / angle
    return polynomial(COSINE, u), k * x, k * y, k * z


@numba.njit(cache=True, nogil=True, inline="always")
def _turn(q: Any, a: Any, b: Any, c: Any) -> Any:
    w, x, y, z = q
    tx, ty, tz = y * c - z * b, z * a - x * c, x * b - y * a
    tx, ty, tz = tx + tx, ty + ty, tz + tz
    return a + w * tx + (y * tz - z * ty), b + w * ty + (z * tx - x * tz), c + w * tz + (x * ty - y * tx)


@numba.njit(cache=True, nogil=True, inline="always")
def _in_frames(frames: Any, at: Any, m: Any, v: Any) -> Any:
    a, b, c = v
    return transposed(
        load4(frames, at) * a + load4(frames, at + 3 * m) * b + load4(frames, at + 6 * m) * c,
        load4(frames, at + m) * a + load4(frames, at + 4 * m) * b + load4(frames, at + 7 * m) * c,
        load4(frames, at + 2 * m) * a + load4(frames, at + 5 * m) * b + load4(frames, at + 8 * m) * c,
    )


@numba.njit(cache=True, nogil=True, inline="always")
def _pulled(z: Any, at: Any, m: Any, k: Any, g: Any, h: Any) -> Any:
    """Stretch a vector (g, h) in the plane at rest."""
    one, half = alike(k, 1.0), scaled(math.sqrt(0.5), k)
    sxx, syy = one + k * load4(z, at + 3 * m), one + k * load4(z, at + 4 * m)
    sxy = half * load4(z, at + 6 * m)
    sxz, syz = half * load4(z, at + 7 * m), half * load4(z, at + 8 * m)
    return sxx * g + sxy * h, sxy * g + syy * h, sxz * g + syz * h


@numba.njit(cache=True, nogil=True)
def decode_faces(
    z: Any, d: Any, frames: Any, step: Any, weigh: Any, pull: Any, rows: Any, wide: Any, X: Any
) -> None:
    """Add the divergence of the deformation gradients of all faces to right-hand sides.

    Parameters
    ----------
    z : (T d,) ndarray
        Coordinates: 9 rows of faces, and at least three more numbers.
    d : int
        Length of one vector.
    frames : (9 m + 3,) or (T (9 m + 3),) ndarray
        Reference frames.
    step : int
        From the frames of one vector to those of the next; 0 if all have the same.
    weigh : (m + 3,) ndarray
        Inverse of the weight of each face, and three more numbers.
    pull : (4 m + 3,) ndarray
        What the second and third corner of each face get at rest, in its frame, and three more numbers.
    rows : (3 m,) int ndarray
        Row of each corner in X.
    wide : int
        Columns of X; vector t has the columns 3 t to 3 t + 3.
    X : (wide (n + 1),) ndarray
        Added to.
    """
    m, count = len(weigh) - 3, len(z) // d
    # some faces at a time for all vectors: their rows and constants stay in the cache
    for begin in range(0, m, TILE):
        for t in range(count):
            for f in range(begin, min(begin + TILE, m), 4):
                k, at = load4(weigh, f), t * d + f
                q = _quaternion(k * load4(z, at), k * load4(z, at + m), k * load4(z, at + 2 * m))
                first = _pulled(z, at, m, k, load4(pull, f), load4(pull, m + f))
                second = _pulled(z, at, m, k, load4(pull, 2 * m + f), load4(pull, 3 * m + f))
                U = _in_frames(frames, t * step + f, m, _turn(q, first[0], first[1], first[2]))
                W = _in_frames(frames, t * step + f, m, _turn(q, second[0], second[1], second[2]))
                for i in range(min(4, m - f)):
                    a = wide * item(rows, f + i) + 3 * t
                    b = wide * item(rows, m + f + i) + 3 * t
                    c = wide * item(rows, 2 * m + f + i) + 3 * t
                    u, w = U[i], W[i]
                    # the fourth number is zero and changes nothing, in whichever column it falls
                    store(X, a, load4(X, a) - (u + w))
                    store(X, b, load4(X, b) + u)
                    store(X, c, load4(X, c) + w)
