"""Joint names as different programs spell them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

_COPY = re.compile(r"[._]\d{3}$")


def same_names(ours: Iterable[str], theirs: Iterable[str]) -> dict[str, str]:
    """Pair names that mean the same joint, the surest spelling first.

    Parameters
    ----------
    ours, theirs : iterable of str
        Distinct names each.

    Returns
    -------
    dict of str to str
        Our name to theirs. Spellings are tried in this order: as it stands; without namespace; without case
        and separators; without the numbers that Blender puts behind copies. A spelling that two joints of
        one side share pairs nothing.

    Examples
    --------
    >>> same_names(["Left Arm", "hips"], ["mixamorig:left_arm", "Hips.001", "Tail"])
    {'Left Arm': 'mixamorig:left_arm', 'hips': 'Hips.001'}
    """
    left, right = dict.fromkeys(ours), dict.fromkeys(theirs)
    pairs: dict[str, str] = {}
    for spelling in (str, _bare, _plain, _original):
        here, there = _unique(left, spelling), _unique(right, spelling)
        for key in [key for key in here if key in there]:
            pairs[here[key]] = there[key]
            del left[here[key]], right[there[key]]
    return pairs


def _unique(names: Iterable[str], spelling: Callable[[str], str]) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    for name in names:
        found.setdefault(spelling(name), []).append(name)
    return {key: same[0] for key, same in found.items() if len(same) == 1 and key}


def _bare(name: str) -> str:
    return re.split(r"[:|/]", name)[-1]


def _plain(name: str) -> str:
    return re.sub(r"[^0-9a-z]+", "", _bare(name).lower())


def _original(name: str) -> str:
    return _plain(_COPY.sub("", _bare(name)))
