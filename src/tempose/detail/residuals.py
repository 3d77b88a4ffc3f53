"""What is left of a clip when its skin is taken away, in the basis in which it is learned."""

from __future__ import annotations

import numpy as np

from tempose.clips import SkeletonClip
from tempose.clips.blocks import read_block
from tempose.detail.posing.skin import Basis, BlockSkin
from tempose.rigging import Rig
from tempose.rotations import to_matrix
from tempose.typing import FloatArray, Progress, silent

__all__ = ["BASES", "Basis", "residuals", "vertex_bases"]

BASES: tuple[Basis, ...] = ("blended", "root", "world")
"""The better ones first, by measurement."""


def check_basis(basis: str) -> Basis:
    """Check the name of a basis.

    Parameters
    ----------
    basis : str
        What the caller gave.

    Returns
    -------
    str
        The same.

    Raises
    ------
    ValueError
        If there is none of that name.
    """
    for known in BASES:
        if basis == known:
            return known
    raise ValueError(f"basis must be one of {', '.join(BASES)}, got {basis!r}")


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
    skin = BlockSkin(rig, check_basis(basis), np.float64)
    quaternions: list[FloatArray] = []
    for row, turn in zip(*skin.rows(motion)):
        skin.pose(row, turn)
        quaternions.append(skin.layout.flat(skin.Q))
    return to_matrix(np.array(quaternions).reshape(motion.n_frames, -1, 4))


def residuals(
    rig: Rig,
    motion: SkeletonClip,
    V: FloatArray,
    basis: Basis = "blended",
    dtype: type = np.float64,
    progress: Progress = silent,
) -> FloatArray:
    """Residuals of frames against the posed skin.

    Parameters
    ----------
    rig : Rig
        n vertices.
    motion : SkeletonClip
        T frames.
    V : (T, n, 3) float
        True frames, metres; an array or a memory map.
    basis : {"blended", "root", "world"}
        In which they are given. In the world, as the paper has it, a body that turns leaves residuals that no
        pose explains.
    dtype : type, default float64
        Of the result.
    progress : Progress
        Told about the frames.

    Returns
    -------
    (T, n, 3) ndarray
        Metres.

    Raises
    ------
    ValueError
        If the frames do not fit the rig or the motion, or a value is not finite.
    """
    n, T = len(rig.skin.mesh.vertices), motion.n_frames
    if V.shape != (T, n, 3):
        raise ValueError(
            f"V must have shape ({T}, {n}, 3), a frame of the mesh for each of the motion, got {V.shape}"
        )
    skin = BlockSkin(rig, check_basis(basis), np.float64)
    D = np.zeros((T, n, 3), dtype)
    for t, (row, turn) in enumerate(zip(*skin.rows(motion))):
        skin.pose(row, turn)
        true = read_block(V, slice(t, t + 1), "V")[0]
        skin.residual(true, motion.root_position[t], D[t])
        progress(t + 1, T, "residuals")
    return D
