"""One frame of a skin at a time, as fast as it goes: vertices that follow the same bones side by side."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.clips import SkinnedMesh
from tempose.rotations import to_matrix
from tempose.typing import FloatArray, IntArray

LANES = 128
"""Vertices of a block: enough for wide instructions, few enough to stay in the first cache."""


class SkinKernel:
    """A skinned mesh laid out for posing single frames.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices, J joints.
    precision : type, default float32
        Type of the vertices that come out; float32 is right to about 3e-7 of the size of the mesh.
    least_weight : float, default 0.0
        Weights below this are dropped and the rest of the row scaled to keep its sum. Heat weights have long
        tails: 1e-5 saves a third of the time and moves no vertex by more than about 1e-5 of the mesh.

    Notes
    -----
    Vertices are sorted by their strongest bones and cut into blocks of `LANES`; a block holds dense weights
    of the bones that reach it, coordinates one after another, so that every loop runs over vertices.
    """

    def __init__(self, skin: SkinnedMesh, precision: type = np.float32, least_weight: float = 0.0) -> None:
        weights = _thinned(skin.weights, least_weight)
        n, J = weights.shape
        # what is bound to nothing follows one more bone, which never moves
        weights = np.column_stack([weights, weights.sum(axis=1) == 0])
        self.skin = skin
        self.precision = np.dtype(precision)
        strongest = np.argsort(-weights, axis=1, kind="stable")[:, :2]
        order = np.lexsort((strongest[:, -1], strongest[:, 0]))
        blocks = -(-n // LANES)
        self.order: IntArray = np.full(blocks * LANES, -1, dtype=np.int64)
        """(blocks * LANES,) vertex in each lane, -1 in those left over."""
        self.order[:n] = order
        self.rest: FloatArray = np.zeros((blocks, 3, LANES), dtype=self.precision)
        """(blocks, 3, LANES) bind pose, metres."""
        padded = np.zeros((blocks * LANES, J + 1))
        padded[:n] = weights[order]
        lanes = np.zeros((blocks * LANES, 3))
        lanes[:n] = skin.mesh.vertices[order]
        self.rest[:] = lanes.reshape(blocks, LANES, 3).transpose(0, 2, 1)
        shares = padded.reshape(blocks, LANES, J + 1).transpose(0, 2, 1)
        block, bone = np.nonzero(shares.any(axis=2))
        self.starts: IntArray = np.searchsorted(block, np.arange(blocks + 1)).astype(np.int64)
        """(blocks + 1,) block b is reached by ``bones[starts[b]:starts[b + 1]]``."""
        self.bones: IntArray = bone.astype(np.int64)
        """(k,) bones; J stands for the one that never moves."""
        self.shares: FloatArray = np.ascontiguousarray(shares[block, bone], dtype=self.precision)
        """(k, LANES) weights of those bones."""

    def matrices(self, turns: FloatArray, shifts: FloatArray) -> FloatArray:
        """Write transforms of the bones as the kernel reads them.

        Parameters
        ----------
        turns : (J, 4) float
            Rotations of the bones from the bind pose, wxyz (`bone_transforms`).
        shifts : (J, 3) float
            Their translations, metres.

        Returns
        -------
        (J + 1, 12) ndarray
            Rows of the 3 x 4 matrices, the last one the identity.
        """
        M = np.concatenate([to_matrix(turns), np.asarray(shifts)[..., None]], axis=-1)
        return np.vstack([M.reshape(-1, 12), np.eye(3, 4).reshape(1, 12)]).astype(self.precision)

    def pose(self, matrices: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Pose one frame.

        Parameters
        ----------
        matrices : (J + 1, 12) float
            From `matrices`.
        out : (n, 3) ndarray, optional
            Where to write, in the kernel's precision.

        Returns
        -------
        (n, 3) ndarray
            Posed vertices, metres; those bound to nothing stay where they are.
        """
        if out is None:
            out = np.zeros(self.skin.mesh.vertices.shape, dtype=self.precision)
        blend_blocks(self.starts, self.bones, self.shares, matrices, self.rest, self.order, out)
        return out


def _thinned(weights: FloatArray, least: float) -> FloatArray:
    thin = np.where(weights >= least, weights, 0.0)
    kept, whole = thin.sum(axis=1), weights.sum(axis=1)
    thin *= np.divide(whole, kept, out=np.zeros_like(kept), where=kept > 0)[:, None]
    return thin


@njit(cache=True, nogil=True, fastmath=True)
def blend_blocks(
    starts: IntArray,
    bones: IntArray,
    shares: FloatArray,
    matrices: FloatArray,
    rest: FloatArray,
    order: IntArray,
    out: FloatArray,
) -> None:
    """Sum the weighted bones of every block.

    Parameters
    ----------
    starts, bones, shares, rest, order : ndarray
        As in `SkinKernel`.
    matrices : (J + 1, 12) float
        Rows of the 3 x 4 matrices.
    out : (n, 3) float
        Posed vertices.
    """
    lanes = rest.shape[2]
    sums = np.zeros((3, lanes), rest.dtype)
    ox, oy, oz = sums[0], sums[1], sums[2]
    for b in range(len(rest)):
        sums[:] = 0
        x, y, z = rest[b, 0], rest[b, 1], rest[b, 2]
        for k in range(starts[b], starts[b + 1]):
            m, w = matrices[bones[k]], shares[k]
            # scalars, or the compiler must assume that the sums overwrite the matrix
            xx, xy, xz, xs = m[0], m[1], m[2], m[3]
            yx, yy, yz, ys = m[4], m[5], m[6], m[7]
            zx, zy, zz, zs = m[8], m[9], m[10], m[11]
            for i in range(lanes):
                ox[i] += w[i] * (xx * x[i] + xy * y[i] + xz * z[i] + xs)
                oy[i] += w[i] * (yx * x[i] + yy * y[i] + yz * z[i] + ys)
                oz[i] += w[i] * (zx * x[i] + zy * y[i] + zz * z[i] + zs)
        for i in range(lanes):
            v = order[b * lanes + i]
            if v >= 0:
                out[v, 0], out[v, 1], out[v, 2] = ox[i], oy[i], oz[i]
