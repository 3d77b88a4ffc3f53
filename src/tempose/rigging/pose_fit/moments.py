"""The energy of a linear blend skin as a quadratic in its bone matrices: vertices are visited once."""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from tempose.clips import SkinnedMesh
from tempose.clips.blocks import cut_blocks, read_block
from tempose.typing import FloatArray

_BLOCK = 1_000_000
_DENSE = 0.25


@dataclass(frozen=True, eq=False)
class FrameMoments:
    """What is left of some frames once their vertices are no longer needed."""

    moments: FloatArray
    """(T, 4 J, 3): rows 4 j to 4 j + 3 hold ``sum_v w_vj [x_v 1] y_v``, centred. Metres squared, metres."""
    energies: FloatArray
    """(T,) ``sum_v |y_v|^2`` of the centred frame, metres squared."""
    centres: FloatArray
    """(T, 3) mean of the bound vertices of each frame, metres."""
    loose: FloatArray
    """(T,) squared distance of vertices bound to nothing from where they stay, metres squared."""

    def __len__(self) -> int:
        return len(self.moments)


class SkinMoments:
    """Second moments of a skin, made once; first moments of any frames.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices, J joints.

    Notes
    -----
    With ``l_v = [w_v1 x_v, w_v1, ..., w_vJ x_v, w_vJ]`` a posed vertex is ``l_v M``, M the stacked (4 J, 3)
    transposed bone matrices. So ``sum |l_v M - y_v|^2 = <M, A M> - 2 <M, B> + c`` with
    ``A = sum l_v^T l_v`` and ``B = sum l_v^T y_v``. Coordinates are taken from the mean of the bound rest
    vertices and of each frame: clips far from the origin lose no digits.
    """

    def __init__(self, skin: SkinnedMesh) -> None:
        self.skin = skin
        J = skin.skeleton.n_joints
        self.bound = np.flatnonzero(skin.weights.any(axis=1))
        if len(self.bound) == 0:
            raise ValueError("weights must bind at least one vertex to a joint, got only zeros")
        self.centre = skin.mesh.vertices[self.bound].mean(axis=0)
        """(3,) mean of the bound vertices in the bind pose, metres."""
        x1 = np.column_stack([skin.mesh.vertices[self.bound] - self.centre, np.ones(len(self.bound))])
        weights = skin.weights[self.bound]
        lifted = (weights[:, :, None] * x1[:, None, :]).reshape(len(self.bound), 4 * J)
        self.A: FloatArray = lifted.T @ lifted
        """(4 J, 4 J) second moments."""
        sparse = np.count_nonzero(weights) < _DENSE * weights.size
        self.lifted = sp.csr_array(lifted.T) if sparse else np.ascontiguousarray(lifted.T)
        """(4 J, bound) rows ``l``, sparse where most weights are zero."""

    def bound_to(self, skin: SkinnedMesh) -> SkinMoments:
        """Take these moments for a skin that differs only in where its joints are.

        Parameters
        ----------
        skin : SkinnedMesh
            The same mesh and weights.

        Returns
        -------
        SkinMoments
            Moments of `skin`, nothing computed again.
        """
        other = copy(self)
        other.skin = skin
        return other

    def frames(self, V: FloatArray, name: str = "frames") -> FrameMoments:
        """Take the moments of frames.

        Parameters
        ----------
        V : (T, n, 3) float
            Target positions, metres; an array or a memory map, read in blocks.
        name : str, default "frames"
            Name of the argument, for the message.

        Returns
        -------
        FrameMoments
            Of T frames.

        Raises
        ------
        ValueError
            If the shape is another or a value is not finite.
        """
        n = len(self.skin.mesh.vertices)
        if V.ndim != 3 or V.shape[1:] != (n, 3):
            raise ValueError(f"{name} must have shape (T, {n}, 3), got {tuple(V.shape)}")
        parts = list(self._blocks(V, name))
        if not parts:
            parts = [_nothing(self.A.shape[0])]
        return FrameMoments(*(np.concatenate(part) for part in zip(*parts)))

    def _blocks(self, V: FloatArray, name: str) -> Iterator[tuple[FloatArray, ...]]:
        n, m = len(self.skin.mesh.vertices), len(self.bound)
        free = np.setdiff1d(np.arange(n), self.bound)
        for part in cut_blocks(len(V), 3 * n, _BLOCK):
            Y = read_block(V, part, name)
            k = len(Y)
            loose = ((Y[:, free] - self.skin.mesh.vertices[free]) ** 2).sum(axis=(1, 2))
            rows = np.ascontiguousarray((Y if m == n else Y[:, self.bound]).transpose(0, 2, 1)).reshape(
                3 * k, m
            )
            centres = rows.mean(axis=1)
            rows -= centres[:, None]
            moments = (self.lifted @ rows.T).reshape(-1, k, 3).transpose(1, 0, 2)
            energies = np.einsum("cv,cv->c", rows, rows).reshape(k, 3).sum(axis=1)
            yield np.ascontiguousarray(moments), energies, centres.reshape(k, 3), loose


def _nothing(rows: int) -> tuple[FloatArray, ...]:
    return np.zeros((0, rows, 3)), np.zeros(0), np.zeros((0, 3)), np.zeros(0)


def about_joints(A: FloatArray, B: FloatArray, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Write moments with every bone's coordinates taken from its own joint.

    Parameters
    ----------
    A : (4 J, 4 J) float
        Second moments of `SkinMoments`.
    B : (T, 4 J, 3) float
        First moments of frames.
    joints : (J, 3) float
        Joints in the bind pose, from the same centre as the moments; metres.

    Returns
    -------
    A : (4 J, 4 J) ndarray
        Second moments of ``w_vj [x_v - p_j, 1]``.
    B : (T, 4 J, 3) ndarray
        First moments.
    """
    J = len(joints)
    A4 = np.array(A).reshape(J, 4, J, 4)
    A4[:, :3] -= joints[:, :, None, None] * A4[:, 3:]
    A4[..., :3] -= A4[..., 3:] * joints[None, None]
    B4 = np.array(B).reshape(-1, J, 4, 3)
    B4[:, :, :3] -= joints[None, :, :, None] * B4[:, :, 3:]
    return A4.reshape(4 * J, 4 * J), B4.reshape(-1, 4 * J, 3)
