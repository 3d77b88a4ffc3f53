"""A motion as named arrays, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.clips.source import Source
from tempose.typing import FloatArray

_PARTS = ("offsets", "rest_rotations", "tips")


def motion_to_arrays(motion: SkeletonClip, bind: Skeleton, name: str) -> dict[str, FloatArray]:
    """Take a motion apart; of its skeleton only what is unlike that of the skin.

    Parameters
    ----------
    motion : SkeletonClip
        On the joints of `bind`.
    bind : Skeleton
        That of the skin.
    name : str
        What the names of the arrays begin with.

    Returns
    -------
    dict of str to ndarray
        Rotations, path of the root and parts of the skeleton.
    """
    arrays = {f"{name}/rotations": motion.rotations, f"{name}/root_position": motion.root_position}
    for part in _PARTS:
        own: Any = getattr(motion.skeleton, part)
        if not np.array_equal(own, getattr(bind, part), equal_nan=True):
            arrays[f"{name}/{part}"] = own
    return arrays


def motion_from_arrays(
    arrays: Mapping[str, Any], facts: Mapping[str, Any], bind: Skeleton, name: str
) -> SkeletonClip:
    """Put a motion together again.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        From `motion_to_arrays`.
    facts : mapping
        ``fps``, ``name`` and ``source``, as JSON can hold them.
    bind : Skeleton
        That of the skin.
    name : str
        What the names of the arrays begin with.

    Returns
    -------
    SkeletonClip
        The same motion.

    Raises
    ------
    ValueError
        If parts do not fit together.
    LookupError
        If a part is missing.
    """
    own = {part: arrays[f"{name}/{part}"] for part in _PARTS if f"{name}/{part}" in arrays}
    return SkeletonClip(
        replace(bind, **own) if own else bind,
        arrays[f"{name}/rotations"],
        arrays[f"{name}/root_position"],
        facts["fps"],
        facts["name"],
        source_from(facts["source"]),
    )


def source_from(fields: Mapping[str, Any]) -> Source:
    """Put a source together again.

    Parameters
    ----------
    fields : mapping
        As JSON gives them back.

    Returns
    -------
    Source
        The same source.
    """
    given: dict[str, Any] = dict(fields)
    # JSON has lists where the fields are tuples
    for name in ("guessed", "notes"):
        given[name] = tuple(given[name])
    return Source(**given)
