"""Names of the other side."""

from __future__ import annotations

import re

_WORDS = {"left": "right", "lft": "rgt", "l": "r"}
_SWAP = _WORDS | {b: a for a, b in _WORDS.items()}
_PATTERN = re.compile(
    r"(?<![A-Za-z])(left|right|LEFT|RIGHT)"  # left_arm, LEFT ARM, leftarm
    r"|(?<![A-Z])(Left|Right)(?![a-z])"  # mixamorig:LeftArm, LeftArm
    r"|(?<![A-Za-z])([lr])(?![A-Za-z])"  # arm.l, r_arm
    r"|(?<![A-Za-z])([LR])(?=[A-Z_.\- ]|$)"  # LArm, arm.R
    r"|(?<=^)([lr])(?=[A-Z])"  # lThigh of older tools
    r"|(?<=^)([lr])(?=(?:thigh|foot|hand|femur|tibia|humerus|radius|wrist|toes|clavicle|fingers|thumb"
    r"|hipjoint)$)",  # ASF of the CMU library
)


def swap_side(name: str) -> str:
    """Exchange left and right in a name.

    Parameters
    ----------
    name : str
        Such as ``"left_forearm"``, ``"mixamorig:LeftArm"``, ``"thigh.L"`` or ``"lhumerus"``.

    Returns
    -------
    str
        The name of the other side; the same where it names no side.

    Examples
    --------
    >>> swap_side("mixamorig:LeftForeArm"), swap_side("thigh.R"), swap_side("spine")
    ('mixamorig:RightForeArm', 'thigh.L', 'spine')
    """

    def swap(match: re.Match[str]) -> str:
        word = match.group(0)
        other = _SWAP[word.lower()]
        if word.isupper():
            return other.upper()
        return other.capitalize() if word[0].isupper() else other

    return _PATTERN.sub(swap, name, count=1)
