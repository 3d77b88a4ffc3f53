"""Which joint of another skeleton moves which joint of ours."""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tempose._tables import read_table
from tempose.clips import Skeleton
from tempose.kinematics import find_roles
from tempose.rigging.motions.names import same_names

_LIMBS = ("thigh", "shin", "upper_arm", "forearm")
_SHOWN = 12


@dataclass(frozen=True)
class JointPairs:
    """Pairs of joints, and who is left over."""

    source: dict[int, int]
    """Index of our joint to index of theirs."""
    missing: tuple[str, ...]
    """Ours that nothing moves: they keep their rest pose relative to their parents."""
    needed: tuple[str, ...]
    """Those of the missing without which the motion is not that motion."""
    unused: tuple[str, ...]
    """Theirs that move nothing."""
    by_role: tuple[str, ...]
    """Ours that were found by the part of the body they play, not by name."""


def read_mapping(path: str | os.PathLike[str]) -> dict[str, str]:
    """Read a file that says which joint is which.

    Parameters
    ----------
    path : path-like
        JSON or TOML: ``{"their joint": "our joint", ...}``.

    Returns
    -------
    dict of str to str
        Their joint to ours.

    Raises
    ------
    ValueError
        If it is no table of names; the message names the file.
    """
    table = read_table(Path(path))
    wrong = [key for key, value in table.items() if not isinstance(value, str)]
    if wrong:
        raise ValueError(f"{path}: expected the name of one of our joints for {wrong[0]!r}")
    return {str(key): str(value) for key, value in table.items()}


def pair_joints(skeleton: Skeleton, source: Skeleton, mapping: Mapping[str, str] | None = None) -> JointPairs:
    """Pair the joints of two skeletons.

    Parameters
    ----------
    skeleton : Skeleton
        Ours, J joints.
    source : Skeleton
        Theirs.
    mapping : mapping of str to str, optional
        Their joint to ours; wins over every guess.

    Returns
    -------
    JointPairs
        By the mapping, else by name, else by the part of a human body that a joint plays.

    Raises
    ------
    ValueError
        If the mapping names a joint that does not exist, or one of ours twice.
    """
    pairs = {ours: theirs for theirs, ours in _stated(skeleton, source, mapping or {}).items()}
    taken = set(pairs.values())
    pairs |= same_names(
        (name for name in skeleton.names if name not in pairs),
        (name for name in source.names if name not in taken),
    )
    roles, other = find_roles(skeleton), find_roles(source)
    by_role: list[str] = []
    for role, j in roles.items():
        ours, theirs = skeleton.names[j], source.names[other[role]] if role in other else ""
        if theirs and ours not in pairs and theirs not in pairs.values():
            pairs[ours] = theirs
            by_role.append(ours)
    missing = tuple(name for name in skeleton.names if name not in pairs)
    needed = _needed(skeleton, roles)
    unused = tuple(name for name in source.names if name not in pairs.values())
    return JointPairs(
        {skeleton.index(ours): source.index(theirs) for ours, theirs in pairs.items()},
        missing,
        tuple(name for name in missing if name in needed),
        unused,
        tuple(by_role),
    )


def _stated(skeleton: Skeleton, source: Skeleton, mapping: Mapping[str, str]) -> dict[str, str]:
    for theirs, ours in mapping.items():
        for name, names, whose in ((theirs, source.names, "the motion"), (ours, skeleton.names, "the rig")):
            if name not in names:
                close = difflib.get_close_matches(name, names, n=5, cutoff=0.3)
                raise ValueError(f"mapping names a joint {name!r}; {whose} has {listed(close or names)}")
    twice = [ours for ours in mapping.values() if list(mapping.values()).count(ours) > 1]
    if twice:
        raise ValueError(f"mapping gives {twice[0]!r} two joints of the motion; one can move it")
    return dict(mapping)


def _needed(skeleton: Skeleton, roles: Mapping[str, int]) -> set[str]:
    """Root and limbs of a human; of anything else every joint that carries another."""
    limbs = [f"{side}_{part}" for side in ("left", "right") for part in _LIMBS]
    if sum(role in roles for role in limbs) >= len(_LIMBS):
        return {skeleton.names[roles[role]] for role in ("hips", *limbs) if role in roles}
    return {skeleton.names[j] for j in range(skeleton.n_joints) if j == 0 or len(skeleton.children(j))}


def listed(names: tuple[str, ...] | list[str]) -> str:
    """Join names for a message, not more than a line of them.

    Parameters
    ----------
    names : sequence of str
        Names.

    Returns
    -------
    str
        The first of them and how many more there are.

    Examples
    --------
    >>> listed(["a", "b"])
    'a, b'
    """
    more = len(names) - _SHOWN
    return ", ".join(names[:_SHOWN]) + (f" and {more} more" if more > 0 else "")
