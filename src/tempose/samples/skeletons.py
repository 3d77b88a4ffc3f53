"""Joints of the built-in characters, placed where anatomy has them.

Tables hold world positions of the rest pose in metres; the left side (+X) is written down, the right is its
mirror image. Human proportions follow the segment lengths of Drillis and Contini [1]_ for a height of 1.75 m;
those of the animal are a horse's, in units of its height at the withers.

References
----------
.. [1] Drillis and Contini, "Body Segment Parameters", New York University, report 1166-03, 1966.
"""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton

WITHERS = 1.1
"""Height of the animal's back at the shoulders, metres."""

Joint = tuple[str, str, tuple[float, float, float]]
Tips = dict[str, tuple[float, float, float]]

_HUMAN_TRUNK: tuple[Joint, ...] = (
    ("hips", "", (0.0, 0.955, -0.010)),
    ("spine", "hips", (0.0, 1.065, -0.012)),
    ("chest", "spine", (0.0, 1.225, -0.028)),
    ("neck", "chest", (0.0, 1.465, -0.036)),
    ("head", "neck", (0.0, 1.570, -0.008)),
)
_HUMAN_LIMBS: tuple[Joint, ...] = (
    ("clavicle", "chest", (0.022, 1.425, 0.012)),
    ("upper_arm", "clavicle", (0.178, 1.427, -0.024)),
    ("forearm", "upper_arm", (0.382, 1.223, -0.030)),
    ("hand", "forearm", (0.556, 1.049, 0.008)),
    ("thigh", "hips", (0.092, 0.915, -0.004)),
    ("shin", "thigh", (0.107, 0.495, 0.004)),
    ("foot", "shin", (0.118, 0.082, -0.036)),
    ("toes", "foot", (0.135, 0.022, 0.098)),
)
_HUMAN_TIPS: Tips = {
    "head": (0.0, 1.750, -0.004),
    "left_hand": (0.684, 0.919, 0.042),
    "left_toes": (0.144, 0.014, 0.172),
}

_ANIMAL_TRUNK: tuple[Joint, ...] = (
    ("hips", "", (0.0, 0.870, -0.380)),
    ("spine_1", "hips", (0.0, 0.875, -0.220)),
    ("spine_2", "spine_1", (0.0, 0.855, -0.050)),
    ("spine_3", "spine_2", (0.0, 0.840, 0.120)),
    ("chest", "spine_3", (0.0, 0.835, 0.270)),
    ("neck_1", "chest", (0.0, 0.850, 0.410)),
    ("neck_2", "neck_1", (0.0, 1.000, 0.560)),
    ("head", "neck_2", (0.0, 1.150, 0.680)),
    ("tail_1", "hips", (0.0, 0.880, -0.535)),
    ("tail_2", "tail_1", (0.0, 0.790, -0.610)),
    ("tail_3", "tail_2", (0.0, 0.660, -0.640)),
    ("tail_4", "tail_3", (0.0, 0.520, -0.645)),
)
_ANIMAL_LIMBS: tuple[Joint, ...] = (
    ("ear", "head", (0.050, 1.215, 0.675)),
    ("fore_scapula", "chest", (0.070, 0.930, 0.290)),
    ("fore_upper", "fore_scapula", (0.115, 0.665, 0.445)),
    ("fore_lower", "fore_upper", (0.120, 0.555, 0.335)),
    ("fore_cannon", "fore_lower", (0.112, 0.305, 0.352)),
    ("fore_hoof", "fore_cannon", (0.110, 0.145, 0.346)),
    ("hind_thigh", "hips", (0.105, 0.790, -0.400)),
    ("hind_shin", "hind_thigh", (0.135, 0.610, -0.285)),
    ("hind_cannon", "hind_shin", (0.112, 0.360, -0.490)),
    ("hind_hoof", "hind_cannon", (0.112, 0.150, -0.468)),
)
_ANIMAL_TIPS: Tips = {
    "head": (0.0, 0.870, 0.950),
    "left_ear": (0.068, 1.320, 0.700),
    "tail_4": (0.0, 0.360, -0.630),
    "left_fore_hoof": (0.110, 0.012, 0.425),
    "left_hind_hoof": (0.112, 0.012, -0.395),
}


def human_skeleton() -> Skeleton:
    """Joints of an adult of 1.75 m in an A-pose, arms 45 degrees down, knees and elbows slightly bent.

    Returns
    -------
    Skeleton
        21 joints from ``hips``; rest rotations are identities, tips are known for head, hands and toes.

    Examples
    --------
    >>> human_skeleton().names[:5]
    ('hips', 'spine', 'chest', 'neck', 'head')
    """
    return _skeleton(_HUMAN_TRUNK, _HUMAN_LIMBS, _HUMAN_TIPS, 1.0)


def animal_skeleton() -> Skeleton:
    """Joints of a pony, 1.1 m at the withers and 1.45 m with its head up, standing square.

    Returns
    -------
    Skeleton
        32 joints from ``hips``; rest rotations are identities, tips for head, ears, tail and hooves.

    Examples
    --------
    >>> animal_skeleton().index("hips")
    0
    """
    return _skeleton(_ANIMAL_TRUNK, _ANIMAL_LIMBS, _ANIMAL_TIPS, WITHERS)


def _skeleton(trunk: tuple[Joint, ...], limbs: tuple[Joint, ...], tips: Tips, scale: float) -> Skeleton:
    joints = list(trunk) + _side("left", limbs, trunk, 1.0) + _side("right", limbs, trunk, -1.0)
    names = tuple(name for name, _, _ in joints)
    parents = np.array([names.index(parent) if parent else -1 for _, parent, _ in joints])
    positions = scale * np.array([position for _, _, position in joints])
    offsets = np.where(parents[:, None] < 0, positions, positions - positions[parents])
    ends = np.full(positions.shape, np.nan)
    for name, tip in tips.items():
        ends[names.index(name)] = scale * np.array(tip) - positions[names.index(name)]
        if name.startswith("left_"):
            other = name.replace("left_", "right_")
            ends[names.index(other)] = ends[names.index(name)] * (-1.0, 1.0, 1.0)
    return Skeleton(names, parents, offsets, tips=ends)


def _side(side: str, limbs: tuple[Joint, ...], trunk: tuple[Joint, ...], sign: float) -> list[Joint]:
    middle = {name for name, _, _ in trunk}
    return [
        (f"{side}_{name}", parent if parent in middle else f"{side}_{parent}", (sign * x, y, z))
        for name, parent, (x, y, z) in limbs
    ]
