"""A previous frame as the new reference pose, so that no rotation is ever interpolated over half a turn.

First remedy of section 4.3 of the paper. Where marks turn against each other by more than the interpolation
can bear, the frame before becomes the reference: source and target are taken as they are there, and only what
turns since then is interpolated. The rotations are composed, ``q(v) = f(v) p(v)`` with p the field at the
reference and f the field of the turns since; the rest shape stays the one that is turned, so that nothing is
lost however often the reference changes, and no matrix has to be factorised again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tempose.rotations import conjugate, multiply, normalise
from tempose.typing import FloatArray, IntArray

SHORT = 0.5
"""Below this length of the interpolated quaternion a new reference is taken."""
Singular = Literal["reference", "path", "none"]
"""Remedies of section 4.3: a previous frame as reference, paths over the surface, or neither."""
Spread = Callable[[FloatArray], FloatArray]
"""(T, C, 4) rotations to their (n, 4, T) field, not normalised."""


@dataclass(frozen=True)
class References:
    """Frames that serve as reference pose."""

    frames: IntArray
    """(S,) reference frames, increasing."""
    fields: tuple[FloatArray, ...]
    """S unit quaternion fields (n, 4) there, against the rest."""
    turns: FloatArray
    """(T, C, 4) rotations of the columns since the reference of each frame."""

    def field(self, spread: Spread, block: slice) -> FloatArray:
        """Compose the quaternion field of some frames.

        Parameters
        ----------
        spread : callable
            Rotations to their field.
        block : slice
            Which frames.

        Returns
        -------
        (n, 4, K) ndarray
            As long as the interpolated part is: a short one still tells of rotations that contradict.
        """
        q = np.moveaxis(spread(self.turns[block]), 1, 2)
        for k, t in enumerate(range(*block.indices(len(self.turns)))):
            i = int(np.searchsorted(self.frames, t, side="left")) - 1
            if i >= 0:
                q[:, k] = multiply(q[:, k], self.fields[i])
        return np.moveaxis(q, 1, 2)


def choose_references(spread: Spread, Q: FloatArray, short: float = SHORT) -> References | None:
    """Find the frames from which on another reference is needed.

    Parameters
    ----------
    spread : callable
        Rotations to their field.
    Q : (T, C, 4) float
        Rotations of the columns through the whole clip, signs continuous in time.
    short : float, default 0.5
        Length of the shortest quaternion below which the frame before becomes the reference.

    Returns
    -------
    References or None
        None where the rest serves for all frames.

    Notes
    -----
    The first frame of a new reference differs from the last of the old one by one frame's turns, so that the
    change does not show. There is no way back to the rest: a limb turned round once stays wound up.
    """
    frames: list[int] = []
    fields: list[FloatArray] = []
    turns = np.array(Q)
    t, previous = 0, np.inf
    while t < len(Q):
        length = _shortest(spread, turns[t])
        if length < short <= previous and t > 0:
            field = normalise(spread(turns[t - 1 : t])[..., 0])
            fields.append(multiply(field, fields[-1]) if fields else field)
            frames.append(t - 1)
            turns[t:] = multiply(Q[t:], conjugate(Q[t - 1]))
            length = _shortest(spread, turns[t])
        previous = length
        t += 1
    return References(np.array(frames), tuple(fields), turns) if frames else None


def _shortest(spread: Spread, q: FloatArray) -> float:
    # weights are positive and sum to one: what leans to one side is never shorter than its lean
    mean = q.mean(axis=0)
    lean = float((q @ mean).min() / max(np.linalg.norm(mean), 1e-12))
    if lean >= SHORT:
        return lean
    return float(np.linalg.norm(spread(q[None])[..., 0], axis=1).min())
