"""Frames of a rig with detail, one after another or many at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import SkeletonClip
from tempose.detail.basis import DetailBasis
from tempose.detail.posing._kernels import add_detail
from tempose.detail.posing.layout import BLOCK, block_weights
from tempose.detail.posing.skin import Basis, BlockSkin
from tempose.rigging import Rig
from tempose.typing import FloatArray, IntArray, Progress, silent


class DetailPoser:
    """A rig and the modes of its detail, laid out for posing.

    Parameters
    ----------
    rig : Rig
        n vertices.
    detail : DetailBasis
        Modes.
    shares : (n, R) float
        Share of every vertex in every region.
    basis : {"blended", "root", "world"}
        In which the modes are.
    scale : (n,) float, optional
        How much of the detail each vertex shows; all of it where left out.
    """

    def __init__(
        self,
        rig: Rig,
        detail: DetailBasis,
        shares: FloatArray,
        basis: Basis = "blended",
        scale: FloatArray | None = None,
    ) -> None:
        self.skin = BlockSkin(rig, basis)
        layout = self.skin.layout
        scaled = shares if scale is None else shares * scale[:, None]
        self._shares = block_weights(layout, scaled)
        self.columns: int = 4 * -(-len(detail.modes) // 4)
        """Columns of coefficients: mean and modes, filled up to fours."""
        blocks: list[Any] = [layout.blocks(mode) for mode in detail.modes]
        self._modes: IntArray = np.zeros((layout.n_blocks, self.columns, 3, BLOCK), np.int16)
        self._modes[:, : len(detail.modes)] = np.stack(blocks, axis=1)

    def frame(
        self, row: FloatArray, turn: FloatArray, root: FloatArray, C: FloatArray, V: FloatArray
    ) -> None:
        """Pose one frame.

        Parameters
        ----------
        row, turn : ndarray
            Of `BlockSkin.rows`.
        root : (3,) float
            Position of the root, metres.
        C : (R, columns) float32
            Coefficient of mean and modes in every region, metres; zeros from 1 + K on.
        V : (n, 3) float
            Filled with vertices, metres.
        """
        skin, shares = self.skin, self._shares
        skin.pose(row, turn)
        add_detail(shares.starts, shares.columns, shares.values, C, self._modes, skin.Q, skin.P)
        skin.write(root, V)

    def frames(self, motion: SkeletonClip, C: FloatArray | None, progress: Progress = silent) -> FloatArray:
        """Pose a motion.

        Parameters
        ----------
        motion : SkeletonClip
            T frames.
        C : (T, R, 1 + K) float, optional
            Coefficients, metres; the skin alone where left out.
        progress : Progress
            Told about the frames.

        Returns
        -------
        (T, n, 3) float32 ndarray
            Vertices, metres.
        """
        n = len(self.skin.rig.skin.mesh.vertices)
        V = np.zeros((motion.n_frames, n, 3), np.float32)
        rows, turns = self.skin.rows(motion)
        padded = None if C is None else np.zeros((C.shape[1], self.columns), np.float32)
        for t, frame in enumerate(V):
            root = motion.root_position[t]
            if C is None or padded is None:
                self.skin.pose(rows[t], turns[t])
                self.skin.write(root, frame)
            else:
                padded[:, : C.shape[2]] = C[t]
                self.frame(rows[t], turns[t], root, padded, frame)
            progress(t + 1, len(V), "posing")
        return V
