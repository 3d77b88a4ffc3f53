"""Rotations of the solver: one a bone, and more that lie between two bones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rotations import conjugate, from_rotation_vector, multiply
from tempose.transfer.turns.twist import continuous_vectors, twist_angles
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Between:
    """A rotation computed from two bones: ``Q_bone exp(share * v)``, v the turn from `first` to `second`."""

    bone: int
    """Bone whose surface it moves and whose rotation it starts from."""
    first: int
    """Bone from which the turn is taken."""
    second: int
    """Bone to which."""
    share: float
    """Which part of the turn; negative where the bone comes after the turn."""
    axis: FloatArray | None = None
    """(3,) unit axis at rest; only the twist about it counts. None for the whole turn."""


@dataclass(frozen=True)
class Columns:
    """What the columns of a solver stand for: first the B bones, then those between two."""

    n_bones: int
    """B."""
    between: tuple[Between, ...] = ()
    """E rotations that follow from the bones."""

    def __len__(self) -> int:
        """Return the number of columns B + E."""
        return self.n_bones + len(self.between)

    @property
    def bones(self) -> IntArray:
        """(B + E,) int, the bone each column belongs to."""
        extra = np.array([e.bone for e in self.between], dtype=np.int64)
        return np.concatenate([np.arange(self.n_bones), extra])

    def rotations(self, Q: FloatArray) -> FloatArray:
        """Compute the rotation of every column.

        Parameters
        ----------
        Q : (T, B, 4) float
            Rotations of the bones through the whole clip, signs continuous in time (`consistent_signs`).

        Returns
        -------
        (T, B + E, 4) ndarray
            Unit quaternions; those between two bones change without a jump however often these turn.
        """
        turns: dict[tuple[int, int, bytes], FloatArray] = {}
        extra: list[FloatArray] = []
        for e in self.between:
            key = (e.first, e.second, b"" if e.axis is None else e.axis.tobytes())
            if key not in turns:
                relative = multiply(conjugate(Q[:, e.first]), Q[:, e.second])
                turns[key] = _turn(relative, e.axis)
            extra.append(multiply(Q[:, e.bone], from_rotation_vector(e.share * turns[key])))
        return np.concatenate([Q, np.stack(extra, axis=1)], axis=1) if extra else Q

    def of_bones(self, basis: FloatArray) -> FloatArray:
        """Sum the fields of columns by bone.

        Parameters
        ----------
        basis : (n, B + E) float
            Field of every column.

        Returns
        -------
        (n, B) ndarray
            Field of every bone.
        """
        if not self.between:
            return basis
        out = np.array(basis[:, : self.n_bones])
        for i, e in enumerate(self.between):
            out[:, e.bone] += basis[:, self.n_bones + i]
        return out


def _turn(relative: FloatArray, axis: FloatArray | None) -> FloatArray:
    if axis is None:
        return continuous_vectors(relative)
    return twist_angles(relative, axis)[:, None] * axis
