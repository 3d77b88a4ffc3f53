"""Where and when rotations come near the half turn at which their interpolation collapses."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.rotations import conjugate, multiply
from tempose.transfer.turns.references import SHORT
from tempose.typing import FloatArray, IntArray


def half_turns(Q: FloatArray, parents: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """First components of the rotations of marks, which are 0 at half a turn.

    Parameters
    ----------
    Q : (T, B, 4) float
        Rotations wxyz relative to the reference pose.
    parents : (B,) int
        Tree of bones, -1 at roots.

    Returns
    -------
    reference : (T,) ndarray
        Smallest ``|w|`` against the reference pose, the turn of the first bone taken out: a person who turns
        round has not come near anything.
    parent : (T,) ndarray
        Smallest ``|w|`` of a bone against its parent.
    bones : (T,) ndarray of int
        Which bone that is.
    """
    own = np.abs(multiply(conjugate(Q[:, :1]), Q)[..., 0])
    above = np.where(parents < 0, 0, parents)
    w = np.abs(multiply(conjugate(Q[:, above]), Q)[..., 0])
    w[:, parents < 0] = 1.0
    return own.min(axis=1), w.min(axis=1), w.argmin(axis=1)


def singular_measures(
    norms: FloatArray,
    vertices: IntArray,
    owner: IntArray,
    names: tuple[str, ...],
    Q: FloatArray,
    parents: IntArray | None,
) -> dict[str, Any]:
    """Report how near each frame comes to a collapse, and where.

    Parameters
    ----------
    norms : (T,) float
        Length of the shortest interpolated quaternion before it is normalised.
    vertices : (T,) int
        Vertex that has it.
    owner : (n,) int
        Bone of largest influence on each vertex.
    names : tuple of str
        B names of the bones; empty where there are none.
    Q : (T, B, 4) float
        Rotations of the bones or marks.
    parents : (B,) int or None
        Tree of bones, if known.

    Returns
    -------
    dict
        ``singular``: per frame ``quaternion_norm``, ``vertex`` and ``bone``, with bones also ``w_reference``,
        ``w_parent`` and ``w_parent_bone`` (0 at half a turn); and ``frames``, those whose shortest quaternion
        is shorter than 0.5.
    """
    found: dict[str, Any] = {
        "frames": [int(t) for t in np.flatnonzero(norms < SHORT)],
        "quaternion_norm": [round(float(x), 3) for x in norms],
        "vertex": [int(v) for v in vertices],
    }
    if names and parents is not None:
        reference, parent, bones = half_turns(Q, parents)
        found |= {
            "bone": [names[int(owner[v])] for v in vertices],
            "w_reference": [round(float(x), 3) for x in reference],
            "w_parent": [round(float(x), 3) for x in parent],
            "w_parent_bone": [names[int(b)] for b in bones],
        }
    return {"singular": found}
