"""Of q and -q the one that interpolates well with its neighbours."""

from __future__ import annotations

import numpy as np

from tempose.rotations import conjugate, multiply
from tempose.typing import FloatArray, IntArray


def consistent_signs(Q: FloatArray, parents: IntArray) -> FloatArray:
    """Choose signs along a tree of bones, continuous in time.

    Parameters
    ----------
    Q : (T, B, 4) float
        Unit quaternions wxyz in the world.
    parents : (B,) int
        Tree, parents first; -1 at roots, which hang on bone 0.

    Returns
    -------
    (T, B, 4) ndarray
        The same rotations. In frame 0 each bone lies within a half turn of its parent; later the rotation
        relative to the parent is continuous, so that a limb that turns past 180 degrees shows no jump.

    Notes
    -----
    The rule is applied to relative rotations: absolute continuity in time contradicts agreement with the
    parent once a limb has turned further than a half turn against it.
    """
    Q = np.array(Q, dtype=np.float64)
    if len(Q) == 0:
        return Q
    parents = np.where(np.asarray(parents) < 0, 0, parents)
    for level in _levels(parents):
        relative = multiply(conjugate(Q[:, parents[level]]), Q[:, level])
        steps = np.where(np.sum(relative[1:] * relative[:-1], axis=-1) < 0, -1.0, 1.0)
        start = np.where(relative[:1, :, 0] < 0, -1.0, 1.0)
        Q[:, level] *= np.cumprod(np.concatenate([start, steps]), axis=0)[..., None]
    return Q


def _levels(parents: IntArray) -> list[IntArray]:
    """Bones by depth, the root left out."""
    depth = np.zeros(len(parents), dtype=np.int64)
    for b in range(1, len(parents)):
        depth[b] = depth[parents[b]] + 1
    order = np.argsort(depth, kind="stable")[1:]
    return np.split(order, np.flatnonzero(np.diff(depth[order])) + 1) if len(order) else []
