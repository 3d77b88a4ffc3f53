"""Adjustments sorted by part: what is asked of each, whether it can be, and in which order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.chains import LimbChain
from tempose.transfer.adjustments.curves import Key
from tempose.transfer.adjustments.parts import Part, find_part
from tempose.transfer.from_skeleton import Prepared


@dataclass
class Group:
    """All adjustments of one part."""

    part: Part
    """The part."""
    index: list[int] = field(default_factory=list[int])
    """Place of each in the list that was given."""
    entries: list[Adjustment] = field(default_factory=list[Adjustment])
    """The adjustments."""
    keys: list[Key] = field(default_factory=list[Key])
    """Frames of each."""


def group_by_part(job: Prepared, adjustments: Sequence[Adjustment], n_frames: int, fps: float) -> list[Group]:
    """Sort adjustments by part, from the body outwards.

    Parameters
    ----------
    job : Prepared
        The transfer.
    adjustments : sequence of Adjustment
        What is asked.
    n_frames : int
        Number of frames T.
    fps : float
        Frames per second.

    Returns
    -------
    list of Group
        The whole body first, then by depth in the tree of bones, so that a hand finds its place last.

    Raises
    ------
    ValueError
        If a part or frame does not exist, a part cannot do what is asked, or two places are asked of one part
        in one frame.
    """
    groups: dict[Any, Group] = {}
    for i, a in enumerate(adjustments):
        try:
            part = find_part(job, a.part)
            first = a.key(n_frames, fps)
            _check_possible(part, a)
        except ValueError as error:
            raise ValueError(f"adjustment {i}: {error}") from None
        last = min(n_frames - 1, first + round(a.hold * fps))
        group = groups.setdefault(part.name if isinstance(a.part, str) else a.part, Group(part))
        group.index.append(i)
        group.entries.append(a)
        pinned = a.to is not None and last > first
        group.keys.append(Key(first, last, a.ease_in * fps, a.ease_out * fps, pinned, [len(group.keys)]))
    for group in groups.values():
        _check_agreement(group)
    return sorted(groups.values(), key=lambda group: _depth(job, group.part))


def _check_possible(part: Part, a: Adjustment) -> None:
    if a.turn is not None and part.bone is None and not part.whole:
        raise ValueError(f"{part.name} cannot be turned: no bone carries it")
    if a.swivel is not None and not isinstance(part.chain, LimbChain):
        raise ValueError(f"{part.name!r} has no elbow or knee to swivel; name a hand or a foot")
    if a.axes != "world" and part.bone is None:
        raise ValueError(f"axes {a.axes!r} need a skeleton as source; use 'world'")
    named = isinstance(a.part, str) and not part.whole
    if a.moves and named and part.chain is None:
        raise ValueError(
            f"{part.name!r} hangs on the hips and cannot move by itself; turn it, or move 'hips'"
        )


def _check_agreement(group: Group) -> None:
    placed = [(i, a, k) for i, a, k in zip(group.index, group.entries, group.keys) if a.to is not None]
    for n, (i, a, k) in enumerate(placed):
        for j, b, other in placed[n + 1 :]:
            meet = max(k.first, other.first)
            if meet <= min(k.last, other.last) and a.to != b.to:
                raise ValueError(
                    f"adjustments {i} and {j} contradict each other: {group.part.name!r} cannot be at "
                    f"{a.to} and at {b.to} in frame {meet}; leave one out or move it to another frame"
                )


def _depth(job: Prepared, part: Part) -> int:
    if part.whole:
        return -1
    if part.bone is None or job.bones is None:
        return 10**6
    depth, bone = 0, part.bone
    while (bone := int(job.bones.parents[bone])) >= 0:
        depth += 1
    return depth
