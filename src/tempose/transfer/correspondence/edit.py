"""A list of pairs that grows as a person works."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tempose.clips import Mesh
from tempose.transfer.pairing.pairs import Kind, Pairs
from tempose.typing import IntArray


def add_pairs(
    pairs: Pairs | None,
    source: Sequence[str] | Sequence[int] | IntArray | str,
    target: Sequence[int] | IntArray,
    *,
    part: str = "",
    how: str = "picked",
    kind: Kind | None = None,
) -> Pairs:
    """Add pairs to a list; a target that is paired already gets the new partner.

    Parameters
    ----------
    pairs : Pairs or None
        The list so far.
    source : str, or sequence of str or int
        Joint names, faces or vertices; one name stands for all targets.
    target : sequence of int
        Faces (or vertices) of the target.
    part : str, optional
        Name of the body part; the joint's name for joints if not given.
    how : str, default "picked"
        See `Pairs.how`.
    kind : str, optional
        Of a new list: joints for names, faces for numbers if not given.

    Returns
    -------
    Pairs
        The longer list.

    Raises
    ------
    ValueError
        If names are added to a list of numbers or the other way round.
    """
    goal = np.asarray(target, dtype=np.int64).reshape(-1)
    start = [source] * len(goal) if isinstance(source, str) else list(source)
    named = bool(start) and isinstance(start[0], str)
    if pairs is None:
        pairs = Pairs(kind or ("joints" if named else "faces"), () if named else np.zeros(0, int), goal[:0])
    if start and named != (pairs.kind == "joints"):
        raise ValueError(f"source of pairs of kind {pairs.kind!r} cannot be {start[0]!r}")
    kept = np.flatnonzero(~np.isin(pairs.target, goal))
    _, first = np.unique(goal, return_index=True)
    first = np.sort(first)
    olds = select_pairs(pairs, kept)
    words = [part or (str(start[i]) if named else "") for i in first]
    told = bool(olds.parts) or any(words)
    return replace(
        olds,
        source=(*olds.source, *(str(start[i]) for i in first))
        if named
        else np.concatenate(
            [np.asarray(olds.source, dtype=np.int64), np.asarray(start, dtype=np.int64)[first]]
        ),
        target=np.concatenate([olds.target, goal[first]]),
        parts=(*(olds.parts or ("",) * len(olds)), *words) if told else (),
        how=(*(olds.how or ("picked",) * len(olds)), *(how,) * len(first)),
    )


def select_pairs(pairs: Pairs, rows: Sequence[int] | IntArray) -> Pairs:
    """Keep some pairs of a list.

    Parameters
    ----------
    pairs : Pairs
        The list.
    rows : sequence of int
        Which, in which order.

    Returns
    -------
    Pairs
        With all that is said about them.
    """
    rows = np.asarray(rows, dtype=np.int64)

    def pick(words: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(words[i] for i in rows) if words else ()

    source = pick(pairs.source) if isinstance(pairs.source, tuple) else pairs.source[rows]
    return replace(
        pairs, source=source, target=pairs.target[rows], parts=pick(pairs.parts), how=pick(pairs.how)
    )


def joint_pairs(pairs: Pairs, template: Mesh) -> Pairs:
    """Turn pairs picked on a template of bones into pairs of joints.

    Parameters
    ----------
    pairs : Pairs
        Of faces of the template.
    template : Mesh
        From `tempose.transfer.skeleton_mesh`: a group of faces a joint.

    Returns
    -------
    Pairs
        Of kind ``"joints"``: all faces of a bone carry the same rotation.

    Raises
    ------
    ValueError
        If the pairs are not of faces, or a face belongs to no bone.
    """
    if pairs.kind != "faces":
        raise ValueError(f"pairs picked on a template must be of kind 'faces', got {pairs.kind!r}")
    owner = {int(f): name for name, faces in template.groups.items() for f in faces}
    lost = [int(f) for f in np.asarray(pairs.source) if int(f) not in owner]
    if lost:
        raise ValueError(f"source face {lost[0]} belongs to no bone of the template; use skeleton_mesh")
    names = tuple(owner[int(f)] for f in np.asarray(pairs.source))
    return replace(pairs, kind="joints", source=names, parts=pairs.parts or names)
