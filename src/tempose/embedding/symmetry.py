"""Left and right of a body help each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.embedding.place import Arm, Leg, Trunk
from tempose.typing import FloatArray

_HALF_SHOULDERS = 0.095
_UNLIKE = 0.4


def mirror_shoulders(
    arms: tuple[Arm, Arm], legs: tuple[Leg, Leg], trunk: Trunk, size: float
) -> tuple[Arm, Arm]:
    """Replace a shoulder that cannot be right by the mirror image of the other.

    Parameters
    ----------
    arms, legs : (Arm, Arm), (Leg, Leg)
        Limbs as placed.
    trunk : Trunk
        Trunk as placed.
    size : float
        Way from the head to the feet.

    Returns
    -------
    (Arm, Arm)
        Unchanged while both shoulders lie equally far from the neck to either side; that of an arm which
        touches the chest does not.
    """
    up = _unit(trunk.neck - trunk.hips)
    across = legs[0].thigh - legs[1].thigh
    across = _unit(across - (across @ up) * up)
    out = np.array([(arm.upper_arm - trunk.neck) @ across for arm in arms])
    if out[0] * out[1] < 0 and abs(np.log(-out[0] / out[1])) < _UNLIKE:
        return arms
    good = int(np.abs(np.abs(out) - _HALF_SHOULDERS * size).argmin())
    mirrored = replace(arms[1 - good], upper_arm=arms[good].upper_arm - 2 * out[good] * across)
    return (arms[0], mirrored) if good == 0 else (mirrored, arms[1])


def unlike_bones(arms: tuple[Arm, Arm], legs: tuple[Leg, Leg]) -> dict[str, float]:
    """Compare the bones of both sides.

    Parameters
    ----------
    arms, legs : (Arm, Arm), (Leg, Leg)
        Limbs as placed.

    Returns
    -------
    dict of str to float
        Ratio of the longer to the shorter bone of each kind, 1 when they are alike.
    """
    ratios: dict[str, float] = {}
    for name, pairs in {
        "upper arms": [(arm.upper_arm, arm.forearm) for arm in arms],
        "forearms": [(arm.forearm, arm.hand) for arm in arms],
        "thighs": [(leg.thigh, leg.shin) for leg in legs],
        "shins": [(leg.shin, leg.foot) for leg in legs],
    }.items():
        one, other = (_length(start, end) for start, end in pairs)
        ratios[name] = max(one, other) / max(min(one, other), 1e-300)
    return ratios


def _length(start: FloatArray, end: FloatArray) -> float:
    return float(np.linalg.norm(end - start))


def _unit(vector: FloatArray) -> FloatArray:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)
