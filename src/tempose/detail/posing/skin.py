"""The skin of a rig laid out for posing one frame after another."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tempose.clips import SkeletonClip
from tempose.detail.posing._kernels import pull_back, scatter, skin_dual, skin_linear
from tempose.detail.posing.joints import dual_rows, joint_turns, linear_rows
from tempose.detail.posing.layout import block_weights, sorted_layout
from tempose.rigging import Rig
from tempose.rotations import IDENTITY
from tempose.typing import FloatArray

Basis = Literal["blended", "root", "world"]
"""In which rotation residuals are kept: that of the vertex, that of the root, none."""


class BlockSkin:
    """Poses frames of a rig, and knows how every vertex has turned.

    Parameters
    ----------
    rig : Rig
        n vertices on J joints.
    basis : {"blended", "root", "world"}
        Which rotation is reported for a vertex.
    dtype : type, default float32
        In which is computed; float32 is twice as fast and exact to 1e-7 of the size of the body.
    """

    def __init__(self, rig: Rig, basis: Basis = "blended", dtype: type = np.float32) -> None:
        skin = rig.skin
        self.rig, self.basis, self.dtype = rig, basis, dtype
        self.layout = sorted_layout(skin.weights)
        self._weights = block_weights(self.layout, skin.weights, dtype)
        self._origin: FloatArray = skin.skeleton.offsets[0]
        self._V: FloatArray = self.layout.blocks((skin.mesh.vertices - self._origin).astype(dtype))
        self._unbound = np.flatnonzero(skin.weights.sum(axis=1) == 0)
        self.P: FloatArray = np.zeros_like(self._V)
        self.Q: FloatArray = np.zeros((len(self._V), 4, self._V.shape[2]), dtype)

    def rows(self, motion: SkeletonClip) -> tuple[FloatArray, FloatArray]:
        """Prepare frames.

        Parameters
        ----------
        motion : SkeletonClip
            T frames.

        Returns
        -------
        rows : (T, J, 16 or 8) ndarray
            What `pose` takes of a frame.
        turns : (T, 4) ndarray
            Rotation of the basis where it is one for all vertices.
        """
        turns, shifts = joint_turns(self.rig.skin, motion)
        layout = dual_rows if self.rig.blending == "dual-quaternion" else linear_rows
        whole = turns[:, 0] if self.basis == "root" else np.broadcast_to(IDENTITY, (len(turns), 4))
        return layout(turns, shifts).astype(self.dtype), whole.astype(self.dtype)

    def pose(self, row: FloatArray, turn: FloatArray) -> None:
        """Pose one frame into `P`, without the position of the root, and set the rotations `Q`.

        Parameters
        ----------
        row : (J, 16 or 8) float
            Of `rows`.
        turn : (4,) float
            Of `rows`.
        """
        w = self._weights
        skin = skin_dual if self.rig.blending == "dual-quaternion" else skin_linear
        skin(w.starts, w.columns, w.values, row, self._V, self.P, self.Q)
        if self.basis != "blended":
            self.Q[:] = turn[:, None]

    def write(self, root: FloatArray, V: FloatArray) -> None:
        """Give out the frame that is posed.

        Parameters
        ----------
        root : (3,) float
            Position of the root, metres.
        V : (n, 3) float
            Filled.
        """
        scatter(self.P, self.layout.order, root, V)
        if len(self._unbound):
            V[self._unbound] = self.rig.skin.mesh.vertices[self._unbound]

    def residual(self, V: FloatArray, root: FloatArray, D: FloatArray) -> None:
        """Compare the frame that is posed with the true one.

        Parameters
        ----------
        V : (n, 3) float
            True frame.
        root : (3,) float
            Position of the root, metres.
        D : (n, 3) float
            Filled with the difference in the rotations of the vertices; zero for what nothing moves.
        """
        pull_back(V, self.P, self.Q, self.layout.order, root, D)
        D[self._unbound] = 0.0
