"""Joint names of any maker read as words: which side, which part of the body."""

from __future__ import annotations

import re

_PARTS: dict[str, tuple[str, ...]] = {
    "finger": (
        *("finger", "fingers", "thumb", "index", "middle", "ring", "pinky", "pinkie", "little", "metacarpal"),
        *("carpal", "fingerbase", "prop", "weapon", "attach", "knuckle"),
    ),
    "clavicle": ("clavicle", "collar", "collarbone", "clav"),
    "shoulder": ("shoulder",),
    "upper_arm": ("upperarm", "uparm", "humerus", "shldr"),
    "arm": ("arm",),
    "forearm": ("forearm", "lowerarm", "loarm", "lowarm", "radius", "elbow", "ulna"),
    "hand": ("hand", "wrist", "palm"),
    "hip_joint": ("hipjoint",),
    "thigh": ("thigh", "upleg", "upperleg", "femur", "uleg"),
    "leg": ("leg",),
    "shin": ("shin", "calf", "tibia", "lowerleg", "loleg", "lowleg", "knee"),
    "foot": ("foot", "ankle"),
    "toes": ("toe", "toes", "toebase", "ball"),
    "hips": ("hips", "hip", "pelvis"),
    "spine": ("spine", "torso"),
    "neck": ("neck", "lowerneck", "upperneck"),
    "head": ("head", "skull"),
}
_WORDS = {word: part for part, words in _PARTS.items() for word in words}
_SIDES = {"l": "left", "left": "left", "lft": "left", "r": "right", "right": "right", "rgt": "right"}
# joints that serve the rig and carry no part of the body themselves, and limbs of four-legged animals
_SERVICE = {
    *(
        "twist",
        "roll",
        "ik",
        "pole",
        "ctrl",
        "control",
        "target",
        "end",
        "nub",
        "leaf",
        "site",
        "dummy",
        "helper",
    ),
    *("front", "fore", "back", "hind", "rear", "tail", "wing", "paw", "hoof", "eff", "effector", "mch"),
}
_NOISE = {"def", "org", "jnt", "joint", "bone", "bip", "bind", "sk", "j", "b", "c"}


def read_names(names: tuple[str, ...]) -> list[tuple[str, str]]:
    """Read the side and the part of the body out of joint names.

    Parameters
    ----------
    names : tuple of str
        Joint names, such as ``"mixamorig:LeftUpLeg"``, ``"lfemur"`` or ``"upperarm01.L"``.

    Returns
    -------
    list of (str, str)
        Side (``"left"``, ``"right"`` or empty) and part for every name: a role without its side,
        ``"arm"``, ``"leg"``, ``"shoulder"``, ``"finger"``, ``"hip_joint"`` or empty.

    Examples
    --------
    >>> read_names(("mixamorig:LeftUpLeg", "mixamorig:Hips", "mixamorig:LeftToe_End"))
    [('left', 'thigh'), ('', 'hips'), ('left', '')]
    """
    return [_read(name) for name in names]


def _read(name: str) -> tuple[str, str]:
    name = re.split(r"[:|/]", name)[-1]
    if name.startswith("__"):
        return "", ""
    words = _split(name)
    sides = [_SIDES[word] for word in words if word in _SIDES]
    words = [word for word in words if word not in _SIDES and word not in _NOISE]
    side = sides[0] if sides else ""
    if not side:
        side, words = _glued_side(words)
    part = _part(words, side)
    return side, "hip_joint" if part == "hips" and side else part


def _split(name: str) -> list[str]:
    # "LHipJoint_2" -> l, hip, joint; a run of capitals ends before its last letter
    spaced = re.sub(r"([a-z])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", name)
    return [word.lower() for word in re.findall(r"[A-Za-z]+", spaced)]


def _glued_side(words: list[str]) -> tuple[str, list[str]]:
    for k, word in enumerate(words):
        for mark in ("left", "right", "l", "r"):
            rest = word.removeprefix(mark)
            if rest != word and rest in _WORDS and word not in _WORDS:
                return _SIDES[mark], [*words[:k], rest, *words[k + 1 :]]
    return "", words


def _part(words: list[str], side: str) -> str:
    # "LeftHandIndex1" is a finger before it is a hand; else the longest run of words that says something
    if side and any(_WORDS.get(word) == "finger" for word in words):
        return "finger"
    for length in (3, 2, 1):
        for start in range(len(words) - length + 1):
            part = _WORDS.get("".join(words[start : start + length]), "finger")
            if part != "finger":
                return "" if _SERVICE.intersection(words[:start] + words[start + length :]) else part
    return ""
