"""Dual-quaternion skinning: blends rigid motions to a rigid motion, so that no joint collapses."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.clips import Skeleton, SkinnedMesh
from tempose.kinematics.bone_transforms import bone_transforms
from tempose.rotations import multiply
from tempose.typing import FloatArray, IntArray


def dual_quaternion_skinning(
    skin: SkinnedMesh, rotations: FloatArray, root_position: FloatArray, skeleton: Skeleton | None = None
) -> FloatArray:
    """Pose a skinned mesh by blended dual quaternions.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to J joints in the skeleton's rest pose.
    rotations : (T, J, 4) float
        Local rotations wxyz.
    root_position : (T, 3) float
        World position of the root, metres.
    skeleton : Skeleton, optional
        The same joints with other offsets, if the motion was made for other bone lengths than the bind pose
        has.

    Returns
    -------
    (T, n, 3) ndarray
        Posed vertices, metres; those bound to nothing stay where they are.

    Notes
    -----
    Section 4 of [1]_. Of the two signs of every bone the one nearer to the bone that holds the vertex most
    is taken.

    References
    ----------
    .. [1] Kavan, Collins, Zara and O'Sullivan, "Geometric Skinning with Approximate Dual Quaternion
       Blending", ACM TOG 27, 2008.
    """
    turns, shifts = bone_transforms(skin.skeleton, rotations, root_position, skeleton)
    real, dual = dual_quaternions(turns, shifts)
    starts, joints, weights = rows_by_strength(skin.weights)
    posed = np.zeros((len(turns), len(skin.mesh.vertices), 3))
    for t in range(len(turns)):
        blend_dual_quaternions(starts, joints, weights, real[t], dual[t], skin.mesh.vertices, posed[t])
    return posed


def dual_quaternions(turns: FloatArray, shifts: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Write rigid transforms as unit dual quaternions.

    Parameters
    ----------
    turns : (..., 4) float
        Unit quaternions wxyz.
    shifts : (..., 3) float
        Translations, metres.

    Returns
    -------
    real, dual : (..., 4) ndarray
        ``turns``, and half the translation times it.
    """
    pure = np.concatenate([np.zeros_like(shifts[..., :1]), shifts], axis=-1)
    return np.array(turns, dtype=np.float64), 0.5 * multiply(pure, turns)


def rows_by_strength(weights: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """List the joints of every vertex, the strongest first.

    Parameters
    ----------
    weights : (n, J) float
        Skin weights.

    Returns
    -------
    starts : (n + 1,) ndarray of int
        Vertex v holds entries ``starts[v]`` to ``starts[v + 1]``.
    joints : (k,) ndarray of int
        Joints.
    weights : (k,) ndarray
        Their weights, none zero.
    """
    order = np.argsort(-weights, axis=1, kind="stable")
    sorted_weights = np.take_along_axis(weights, order, axis=1)
    kept = sorted_weights > 0
    starts = np.concatenate([[0], np.cumsum(kept.sum(axis=1))])
    return starts, order[kept].astype(np.int64), np.ascontiguousarray(sorted_weights[kept])


@njit(cache=True, nogil=True)
def blend_dual_quaternions(
    starts: IntArray,
    joints: IntArray,
    weights: FloatArray,
    real: FloatArray,
    dual: FloatArray,
    V: FloatArray,
    out: FloatArray,
) -> None:
    """Pose one frame.

    Parameters
    ----------
    starts, joints, weights : ndarray
        From `rows_by_strength`.
    real, dual : (J, 4) float
        Unit dual quaternions of the bones.
    V : (n, 3) float
        Bind pose, metres.
    out : (n, 3) float
        Posed vertices, written.
    """
    b = np.zeros(8)
    for v in range(len(V)):
        first = starts[v]
        if first == starts[v + 1]:
            out[v] = V[v]
            continue
        pivot = real[joints[first]]
        b[:] = 0
        for k in range(first, starts[v + 1]):
            r, d = real[joints[k]], dual[joints[k]]
            w = weights[k]
            if r[0] * pivot[0] + r[1] * pivot[1] + r[2] * pivot[2] + r[3] * pivot[3] < 0:
                w = -w
            for i in range(4):
                b[i] += w * r[i]
                b[4 + i] += w * d[i]
        square = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3]
        w, x, y, z = b[0], b[1], b[2], b[3]
        X, Y, Z = V[v, 0], V[v, 1], V[v, 2]
        # t = 2 r x V; rotated = V + (w t + r x t) / |b|^2
        tx, ty, tz = 2 * (y * Z - z * Y), 2 * (z * X - x * Z), 2 * (x * Y - y * X)
        e, f, g, h = b[4], b[5], b[6], b[7]
        out[v, 0] = X + (w * tx + y * tz - z * ty + 2 * (w * f - e * x + y * h - z * g)) / square
        out[v, 1] = Y + (w * ty + z * tx - x * tz + 2 * (w * g - e * y + z * f - x * h)) / square
        out[v, 2] = Z + (w * tz + x * ty - y * tx + 2 * (w * h - e * z + x * g - y * f)) / square
