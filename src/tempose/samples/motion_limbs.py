"""A limb as a chain of hinges with one degree of bend: forward and inverse kinematics.

In every limb the hinges bend together by fixed ratios, as muscles over two joints make them: a human knee
alone, a horse's stifle and hock in opposite senses. So the length from the first joint to the end is a
monotone function of one angle, the *flexion*, and the limb reaches a point by flexion and one rotation.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose.clips import Skeleton
from tempose.rotations import from_matrix
from tempose.samples.motion_curves import about
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Limb:
    """Bones from a hip or shoulder to an ankle, hinged about the X axis of the rest pose."""

    joints: tuple[int, ...]
    """k joints from the first to the last that bears a bone, then the foot: k + 1 indices."""
    bones: FloatArray
    """(k, 3) metres, each bone in the rest pose."""
    ratio: FloatArray
    """(k - 1,) radians by which each hinge bends for a radian of flexion."""
    fold: FloatArray
    """(k - 1,) radians for a radian of fold, the extra bend of a swinging limb."""
    swing: FloatArray
    """(k - 1,) radians for a radian of swing of the whole limb."""
    straight: FloatArray = field(default_factory=lambda: np.zeros(1))
    """(k - 1,) radians at zero flexion."""
    limits: tuple[float, float] = (0.0, 2.6)
    """Flexion between which the length falls monotonically, radians."""


def human_leg(skeleton: Skeleton, side: str) -> Limb:
    """Leg with ``thigh``, ``shin`` and ``foot``; flexion is the angle of the knee from straight.

    Parameters
    ----------
    skeleton : Skeleton
        With the joints named above.
    side : str
        ``"left"`` or ``"right"``.

    Returns
    -------
    Limb
        Two bones.
    """
    joints = tuple(skeleton.index(f"{side}_{name}") for name in ("thigh", "shin", "foot"))
    bones = skeleton.offsets[list(joints[1:])]
    slope = np.arctan2(bones[:, 2], -bones[:, 1])
    zero = np.zeros(1)
    return Limb(joints, bones, np.ones(1), zero, zero, np.array([slope[1] - slope[0]]))


def limb_bends(limb: Limb, flexion: FloatArray, fold: FloatArray, swing: FloatArray) -> FloatArray:
    """Bend of each hinge from the rest pose.

    Parameters
    ----------
    limb : Limb
        k bones.
    flexion, fold, swing : (T,) float
        Radians.

    Returns
    -------
    (T, k - 1) ndarray
        Radians about X.
    """
    return (
        limb.straight
        + flexion[:, None] * limb.ratio
        + fold[:, None] * limb.fold
        + np.asarray(swing)[:, None] * limb.swing
    )


def limb_vector(limb: Limb, flexion: FloatArray, fold: FloatArray, swing: FloatArray) -> FloatArray:
    """Vector from the first joint to the end, in the basis of the first bone.

    Parameters
    ----------
    limb : Limb
        k bones.
    flexion, fold, swing : (T,) float
        Radians.

    Returns
    -------
    (T, 3) ndarray
        Metres.
    """
    angle = np.cumsum(limb_bends(limb, flexion, fold, swing), axis=1)
    # hinges turn about X: a rotation of the plane of Y and Z, as complex numbers
    plane = limb.bones[:, 1] + 1j * limb.bones[:, 2]
    end = plane[0] + np.exp(1j * angle) @ plane[1:]
    return np.stack([np.full(len(end), limb.bones[:, 0].sum()), end.real, end.imag], axis=1)


def flexion_for_length(limb: Limb, length: FloatArray, fold: FloatArray, swing: FloatArray) -> FloatArray:
    """Flexion at which the limb has a given length.

    Parameters
    ----------
    limb : Limb
        k bones.
    length : (T,) float
        Metres; clipped to what the limb can reach.
    fold, swing : (T,) float
        Radians.

    Returns
    -------
    (T,) ndarray
        Radians, to rounding.

    Notes
    -----
    Bisection, since the slope vanishes at the straight limb, where Newton's method would leap.
    """
    low = np.full(len(length), limb.limits[0])
    high = np.full(len(length), limb.limits[1])
    for _ in range(54):
        middle = 0.5 * (low + high)
        too_long = np.linalg.norm(limb_vector(limb, middle, fold, swing), axis=1) > length
        low, high = np.where(too_long, middle, low), np.where(too_long, high, middle)
    return 0.5 * (low + high)


def aim_limb(limb_vectors: FloatArray, target: FloatArray, lateral: FloatArray) -> FloatArray:
    """Rotation of the first bone that points the limb at its target with the hinges lying sideways.

    Parameters
    ----------
    limb_vectors : (T, 3) float
        Limb in the basis of its first bone, metres.
    target : (T, 3) float
        Where the limb shall point, in the world.
    lateral : (T, 3) float
        Direction in the world that the hinge axis X shall have as nearly as it can.

    Returns
    -------
    (T, 4) ndarray
        World rotations wxyz.
    """
    return from_matrix(_basis(target, lateral) @ _basis(limb_vectors, np.eye(3)[0]).swapaxes(-1, -2))


def _basis(along: FloatArray, lateral: FloatArray) -> FloatArray:
    e1 = along / np.linalg.norm(along, axis=-1, keepdims=True)
    e3 = lateral - np.sum(lateral * e1, axis=-1, keepdims=True) * e1
    e3 = e3 / np.linalg.norm(e3, axis=-1, keepdims=True)
    return np.stack([e1, np.cross(e3, e1), e3], axis=-1)


def hinge_rotations(limb: Limb, flexion: FloatArray, fold: FloatArray, swing: FloatArray) -> FloatArray:
    """Local rotations of the bones after the first.

    Parameters
    ----------
    limb : Limb
        k bones.
    flexion, fold, swing : (T,) float
        Radians.

    Returns
    -------
    (T, k - 1, 4) ndarray
        Quaternions wxyz.
    """
    return about("x", limb_bends(limb, flexion, fold, swing))
