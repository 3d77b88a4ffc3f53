"""Twist spread along a limb: marks carry the share of it that their place on the bone asks for."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.turns.columns import Between, Columns
from tempose.typing import FloatArray, IntArray

FROM_BELOW = {"forearm": "hand"}
"""Parts that take up the twist of the part they carry, all of it at their end."""
FROM_ABOVE = ("thigh", "upper_arm")
"""Parts that take up their own twist against what carries them, all of it from `WHOLE` on."""
WHOLE = 0.75
_WIDTH = 0.12


def twist_columns(
    bones: Bones, target: BonePose, centres: FloatArray, marks: IntArray
) -> tuple[Columns, IntArray]:
    """Give marks of arms and thighs columns of their own, by their place along the bone.

    Parameters
    ----------
    bones : Bones
        B bones.
    target : BonePose
        (B,) target at rest.
    centres : (k, 3) float
        Centres of the marked faces at rest.
    marks : (k,) int
        Bone of each marked face.

    Returns
    -------
    columns : Columns
        Bones and the rotations between them.
    of_mark : (k,) ndarray of int
        Column of each marked face.

    Notes
    -----
    A forearm whose marks are all rigid passes the whole twist of the hand to the wrist, which shrinks to 0.6
    of its radius at 179 degrees; a real forearm turns little by little, as radius and ulna cross.
    """
    between: list[Between] = []
    of_mark = np.array(marks, dtype=np.int64)
    for b in range(len(bones.names)):
        turn = _turn_of(bones, b)
        length = float(target.lengths[b])
        mine = np.flatnonzero(of_mark == b)
        if turn is None or length == 0 or len(mine) == 0:
            continue
        axis = target.directions[b]
        place = np.clip((centres[mine] - target.starts[b]) @ axis / length, 0, 1)
        for group in _groups(place):
            share = float(place[group].mean())
            if turn[1] == b:
                share = min(share / WHOLE, 1.0) - 1.0
            of_mark[mine[group]] = len(bones.names) + len(between)
            between.append(Between(b, *turn, share, axis))
    return Columns(len(bones.names), tuple(between)), of_mark


def _turn_of(bones: Bones, b: int) -> tuple[int, int] | None:
    """Bones between which the twist arises that a bone spreads."""
    side, part = split_role(bones.roles[b])
    if part in FROM_BELOW:
        end = bones.find(side + FROM_BELOW[part])
        return None if end is None or bones.parents[end] != b else (b, end)
    above = int(bones.parents[b])
    return (above, b) if part in FROM_ABOVE and above >= 0 else None


def _groups(place: FloatArray) -> list[IntArray]:
    """Cut places into stretches of at most `_WIDTH`, a ring in one."""
    order = np.argsort(place, kind="stable")
    cuts, begin = [0], 0
    for i, j in enumerate(order):
        if place[j] - place[order[begin]] > _WIDTH:
            cuts.append(i)
            begin = i
    return [order[a:b] for a, b in pairwise([*cuts, len(order)])]
