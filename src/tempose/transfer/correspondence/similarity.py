"""Similarities: scale, turn and translation from source to target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.rotations import conjugate, from_matrix, multiply, polar_rotation, rotate, to_matrix
from tempose.transfer.bodies.facing import yaw
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Alignment:
    """The similarity ``x -> scale * R x + translation`` from source to target, determinant positive."""

    scale: float
    """Target metres per source metre."""
    rotation: FloatArray
    """(4,) unit quaternion wxyz."""
    translation: FloatArray
    """(3,) metres."""
    residual: float = 0.0
    """Trimmed rms distance between the two surfaces, share of the target's diagonal; of the joints where
    those were used."""
    ambiguity: float = 0.0
    """Residual over that of the best clearly different turn: near 1 nothing tells the two apart."""
    other: FloatArray | None = None
    """(4,) that second turn, for a person to choose."""
    warnings: tuple[str, ...] = ()
    """What is doubtful."""

    def apply(self, points: FloatArray) -> FloatArray:
        """Carry points of the source over to the target.

        Parameters
        ----------
        points : (..., 3) float
            Metres.

        Returns
        -------
        (..., 3) ndarray
            Metres.
        """
        return self.scale * rotate(self.rotation, np.asarray(points, dtype=np.float64)) + self.translation

    def inverse(self) -> Alignment:
        """Return the way back.

        Returns
        -------
        Alignment
            From target to source.
        """
        back = conjugate(self.rotation)
        return Alignment(
            1 / self.scale,
            back,
            -rotate(back, self.translation) / self.scale,
            self.residual,
            self.ambiguity,
            None if self.other is None else conjugate(self.other),
            self.warnings,
        )


def align_points(source: FloatArray, target: FloatArray, *, upright: bool = False) -> Alignment:
    """Similarity between points whose partners are known, such as joints of the same roles or pairs.

    Parameters
    ----------
    source, target : (k, 3) float
        Corresponding points, metres.
    upright : bool, default False
        Whether only turns about the vertical are allowed.

    Returns
    -------
    Alignment
        The least-squares similarity [1]_; its residual is that of the points.

    Raises
    ------
    ValueError
        If there are too few points, or they lie in one place.

    References
    ----------
    .. [1] Umeyama, "Least-Squares Estimation of Transformation Parameters Between Two Point Patterns",
       PAMI 1991.
    """
    P = as_floats(source, "source", ("k", 3))
    Q = as_floats(target, "target", (len(P), 3))
    if len(P) < (2 if upright else 3):
        raise ValueError(f"source must hold at least 3 points (2 upright), got {len(P)}")
    size = float(np.linalg.norm(np.ptp(Q, axis=0)))
    if size == 0 or np.ptp(P, axis=0).max() == 0:
        raise ValueError("source and target points must not all lie in one place")
    scale, R, shift = fit_similarity(P, Q, np.ones(len(P)), upright)
    rms = float(np.sqrt(((scale * P @ R.T + shift - Q) ** 2).sum(axis=1).mean()))
    return Alignment(scale, from_matrix(R), shift, rms / size)


def fit_similarity(
    P: FloatArray, Q: FloatArray, weights: FloatArray, upright: bool
) -> tuple[float, FloatArray, FloatArray]:
    """Least-squares similarity from `P` to `Q`, treating both alike.

    Parameters
    ----------
    P, Q : (k, 3) float
        Corresponding points.
    weights : (k,) float
        Weight of each.
    upright : bool
        Whether to turn about +Y only.

    Returns
    -------
    scale : float
        Ratio of the spreads, which unlike the one-sided optimum does not shrink with the noise.
    R : (3, 3) ndarray
        Rotation.
    shift : (3,) ndarray
        Translation.
    """
    w = weights / weights.sum()
    p, q = w @ P, w @ Q
    P, Q = P - p, Q - q
    A = (w[:, None] * Q).T @ P
    if upright:
        s, c = A[0, 2] - A[2, 0], A[0, 0] + A[2, 2]
        R = to_matrix(yaw(np.arctan2(s, c)))
    else:
        R = polar_rotation(A)
    scale = float(np.sqrt((w @ (Q**2).sum(axis=1)) / max(float(w @ (P**2).sum(axis=1)), 1e-300)))
    return scale, R, q - scale * R @ p


def turned(alignment: Alignment, turn: FloatArray, centre: FloatArray) -> Alignment:
    """Turn an alignment in the target about a point, as a person does who corrects it.

    Parameters
    ----------
    alignment : Alignment
        The first guess.
    turn : (4,) float
        Rotation wxyz to add.
    centre : (3,) float
        Point of the target that stays, metres.

    Returns
    -------
    Alignment
        The same scale; residual and ambiguity unknown (0).
    """
    centre = np.asarray(centre, dtype=np.float64)
    return Alignment(
        alignment.scale,
        multiply(turn, alignment.rotation),
        rotate(turn, alignment.translation - centre) + centre,
    )
