"""One frame of a skeleton: turns of the joints since the bind pose, and their rotation vectors."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True)
def joint_rows(
    parents: IntArray,
    offsets: FloatArray,
    bind_back: FloatArray,
    bind_arms: FloatArray,
    rotations: FloatArray,
    turns: FloatArray,
    shifts: FloatArray,
) -> None:
    """Turn and shift the joints of one frame, as `joint_turns` does.

    Parameters
    ----------
    parents, offsets : (J,) int, (J, 3) float
        The skeleton.
    bind_back : (J, 4) float
        Inverse rotations of the bind pose in the world.
    bind_arms : (J, 3) float
        Joints of the bind pose, from the root.
    rotations : (J, 4) float
        Local rotations wxyz.
    turns, shifts : (J, 4) float, (J, 3) float
        Filled.
    """
    J = len(parents)
    world, place = np.zeros((J, 4)), np.zeros((J, 3))
    for j in range(J):
        p = parents[j]
        if p < 0:
            world[j] = rotations[j]
        else:
            _multiply(world[p], rotations[j], world[j])
            _rotate(world[p], offsets[j], place[j])
            for a in range(3):
                place[j, a] += place[p, a]
        _multiply(world[j], bind_back[j], turns[j])
        if p >= 0:
            alike = 0.0
            for c in range(4):
                alike += turns[j, c] * turns[p, c]
            if alike < 0:
                for c in range(4):
                    turns[j, c] = -turns[j, c]
        _rotate(turns[j], bind_arms[j], shifts[j])
        for a in range(3):
            shifts[j, a] = place[j, a] - shifts[j, a]


@njit(cache=True)
def rotation_vectors(
    rest_back: FloatArray, rotations: FloatArray, near: FloatArray, vectors: FloatArray
) -> None:
    """Rotation vectors of one frame below the root, those nearest to others.

    Parameters
    ----------
    rest_back : (J, 4) float
        Inverse local rotations of the rest pose.
    rotations : (J, 4) float
        Local rotations wxyz.
    near : (J - 1, 3) float
        Others, radians.
    vectors : (J - 1, 3) float
        Filled, radians.
    """
    q = np.zeros(4)
    axis = np.zeros(3)
    for j in range(1, len(rotations)):
        _multiply(rest_back[j], rotations[j], q)
        if q[0] < 0:
            for c in range(4):
                q[c] = -q[c]
        sine = math.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        angle = 2.0 * math.atan2(sine, q[0])
        wanted = near[j - 1]
        length = math.sqrt(wanted[0] ** 2 + wanted[1] ** 2 + wanted[2] ** 2)
        along = 0.0
        for a in range(3):
            # no turn has no axis: any will do, so the one that is wanted
            if angle > 1e-9:
                axis[a] = q[1 + a] / sine
            else:
                axis[a] = wanted[a] / length if length > 0 else 0.0
            along += axis[a] * wanted[a]
        angle += 2.0 * math.pi * np.round((along - angle) / (2.0 * math.pi))
        for a in range(3):
            vectors[j - 1, a] = angle * axis[a]


@njit(cache=True)
def linear_row(turns: FloatArray, shifts: FloatArray, M: FloatArray) -> None:
    """Lay out one frame for linear blend skinning, as `linear_rows` does.

    Parameters
    ----------
    turns, shifts : (J, 4) float, (J, 3) float
        Of the joints.
    M : (J, 16) float
        Filled with matrix by rows, shift, quaternion.
    """
    for j in range(len(turns)):
        w, x, y, z = turns[j, 0], turns[j, 1], turns[j, 2], turns[j, 3]
        M[j, 0], M[j, 1], M[j, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
        M[j, 3], M[j, 4], M[j, 5] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
        M[j, 6], M[j, 7], M[j, 8] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
        M[j, 9], M[j, 10], M[j, 11] = shifts[j, 0], shifts[j, 1], shifts[j, 2]
        M[j, 12], M[j, 13], M[j, 14], M[j, 15] = w, x, y, z


@njit(cache=True)
def dual_row(turns: FloatArray, shifts: FloatArray, M: FloatArray) -> None:
    """Lay out one frame for dual-quaternion skinning, as `dual_rows` does.

    Parameters
    ----------
    turns, shifts : (J, 4) float, (J, 3) float
        Of the joints.
    M : (J, 8) float
        Filled with real and dual parts.
    """
    pure, dual = np.zeros(4), np.zeros(4)
    for j in range(len(turns)):
        pure[1], pure[2], pure[3] = 0.5 * shifts[j, 0], 0.5 * shifts[j, 1], 0.5 * shifts[j, 2]
        _multiply(pure, turns[j], dual)
        for c in range(4):
            M[j, c], M[j, 4 + c] = turns[j, c], dual[c]


@njit(cache=True)
def _multiply(p: FloatArray, q: FloatArray, out: FloatArray) -> None:
    out[0] = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    out[1] = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    out[2] = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    out[3] = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]


@njit(cache=True)
def _rotate(q: FloatArray, x: FloatArray, out: FloatArray) -> None:
    a = 2.0 * (q[2] * x[2] - q[3] * x[1])
    b = 2.0 * (q[3] * x[0] - q[1] * x[2])
    c = 2.0 * (q[1] * x[1] - q[2] * x[0])
    out[0] = x[0] + q[0] * a + q[2] * c - q[3] * b
    out[1] = x[1] + q[0] * b + q[3] * a - q[1] * c
    out[2] = x[2] + q[0] * c + q[1] * b - q[2] * a
