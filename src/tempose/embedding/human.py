"""The human skeleton that is placed: 18 joints, and those that follow from them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tempose.clips import Skeleton
from tempose.typing import FloatArray

SIDES = ("left", "right")
_ARM = ("upper_arm", "forearm", "hand")
_LEG = ("thigh", "shin", "foot", "toes")
NAMES = (
    "hips",
    "spine",
    "neck",
    "head",
    *(f"{side}_{part}" for side in SIDES for part in _ARM),
    *(f"{side}_{part}" for side in SIDES for part in _LEG),
)
"""The 18 joints, by the roles of `tempose.kinematics.roles`."""
TERMINALS = ("head", *(f"{side}_{part}" for part in ("hand", "toes") for side in SIDES))
"""Joints whose bone ends at no other joint."""
_CHEST = 0.66
_CLAVICLE = 0.16


def _parents() -> tuple[int, ...]:
    above = {"hips": "", "spine": "hips", "neck": "spine", "head": "neck"}
    for side in SIDES:
        arm = ("neck", *(f"{side}_{part}" for part in _ARM))
        leg = ("hips", *(f"{side}_{part}" for part in _LEG))
        above |= dict(zip(arm[1:], arm)) | dict(zip(leg[1:], leg))
    return tuple(NAMES.index(above[name]) if above[name] else -1 for name in NAMES)


PARENTS = _parents()
"""Parent of each of the 18 joints."""


def role_skeleton(joints: FloatArray, ends: dict[str, FloatArray]) -> Skeleton:
    """Build the skeleton of all body roles from the 18 embedded joints.

    Parameters
    ----------
    joints : (18, 3) float
        Positions in the order of `NAMES`, metres.
    ends : dict of str to (3,) float
        Far end of each bone of `TERMINALS`.

    Returns
    -------
    Skeleton
        21 joints: the 18, the chest at two thirds of the way from spine to neck, and the clavicles,
        which start beside the neck. Rest rotations are the identity.
    """
    at = {name: np.asarray(joints[j], dtype=np.float64) for j, name in enumerate(NAMES)}
    at["chest"] = at["spine"] + _CHEST * (at["neck"] - at["spine"])
    chain = [("hips", ""), ("spine", "hips"), ("chest", "spine"), ("neck", "chest"), ("head", "neck")]
    for side in SIDES:
        base = at["chest"] + 0.7 * (at["neck"] - at["chest"])
        at[f"{side}_clavicle"] = base + _CLAVICLE * (at[f"{side}_upper_arm"] - base)
        arm = ("chest", *(f"{side}_{part}" for part in ("clavicle", *_ARM)))
        leg = ("hips", *(f"{side}_{part}" for part in _LEG))
        chain += list(zip(arm[1:], arm)) + list(zip(leg[1:], leg))
    names = tuple(name for name, _ in chain)
    offsets = [at[name] - (at[above] if above else 0.0) for name, above in chain]
    tips = [ends[name] - at[name] if name in ends else np.full(3, np.nan) for name in names]
    parents = [names.index(above) if above else -1 for _, above in chain]
    return Skeleton(names, np.array(parents), np.array(offsets), tips=np.array(tips))


def joint_skeleton(joints: FloatArray, ends: Mapping[str, FloatArray]) -> Skeleton:
    """Build the skeleton of the 18 embedded joints alone.

    Parameters
    ----------
    joints : (18, 3) float
        Positions in the order of `NAMES`, metres.
    ends : mapping of str to (3,) float
        Far end of each bone of `TERMINALS`.

    Returns
    -------
    Skeleton
        18 joints; rest rotations are the identity.
    """
    P = np.asarray(joints, dtype=np.float64)
    offsets = [p - (P[above] if above >= 0 else 0.0) for p, above in zip(P, PARENTS)]
    tips = [ends[name] - P[j] if name in ends else np.full(3, np.nan) for j, name in enumerate(NAMES)]
    return Skeleton(NAMES, np.array(PARENTS), np.array(offsets), tips=np.array(tips))
