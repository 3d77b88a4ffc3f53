"""What is left of a clip when its skin is taken away, in the basis in which it is learned."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tempose.clips import SkeletonClip
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rigging import Rig
from tempose.rotations import conjugate, multiply, to_matrix
from tempose.typing import FloatArray

Basis = Literal["blended", "root", "world"]


def vertex_bases(rig: Rig, motion: SkeletonClip, basis: Basis = "blended") -> FloatArray:
    """Rotation from the basis of the residual to the world, for every vertex of every frame.

    Parameters
    ----------
    rig : Rig
        n vertices.
    motion : SkeletonClip
        T frames.
    basis : {"blended", "root", "world"}
        The blended rotation of the vertex, the root's, or none.

    Returns
    -------
    (T, n, 3, 3) ndarray
        Rotations.
    """
    T, n = motion.n_frames, len(rig.skin.mesh.vertices)
    if basis == "world":
        return np.broadcast_to(np.eye(3), (T, n, 3, 3))
    world, _ = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)
    turn = multiply(world, conjugate(rest_transforms(rig.skin.skeleton)[0]))
    if basis == "root":
        return np.broadcast_to(to_matrix(turn[:, :1]), (T, n, 3, 3))
    q = np.zeros((T, n, 4))
    reference = turn[:, :1]
    signs = np.where((turn * reference).sum(axis=-1, keepdims=True) < 0, -1.0, 1.0)
    q = np.einsum("nj,tjk->tnk", rig.skin.weights, signs * turn)
    return to_matrix(q / np.linalg.norm(q, axis=-1, keepdims=True))


def residuals(rig: Rig, motion: SkeletonClip, V: FloatArray, basis: Basis = "blended") -> FloatArray:
    """Residuals of frames against the posed skin.

    Parameters
    ----------
    rig : Rig
        n vertices.
    motion : SkeletonClip
        T frames.
    V : (T, n, 3) float
        True frames, metres.
    basis : {"blended", "root", "world"}
        In which they are given.

    Returns
    -------
    (T, n, 3) ndarray
        Metres.
    """
    world = np.asarray(V, dtype=np.float64) - rig.vertices(motion)
    return np.einsum("tnba,tnb->tna", vertex_bases(rig, motion, basis), world)
