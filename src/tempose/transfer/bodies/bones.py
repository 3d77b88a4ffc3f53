"""The bones that source and target share, and where they lie in either."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import BoneEnd, bone_ends, forward_kinematics
from tempose.rotations import rotate
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Bones:
    """B rigid parts of the source: a joint each, the joint where each ends, a tree."""

    names: tuple[str, ...]
    """B joint names of the source."""
    roles: tuple[str, ...]
    """B body roles such as ``"left_forearm"``; empty where there is none."""
    joints: IntArray
    """(B,) int, joint of the source skeleton at which each bone starts."""
    parents: IntArray
    """(B,) int, nearest bone above in the skeleton; -1 at the root."""

    def find(self, role: str) -> int | None:
        """Return the bone of a role.

        Parameters
        ----------
        role : str
            Body role.

        Returns
        -------
        int or None
            Its index.
        """
        return self.roles.index(role) if role in self.roles else None


def make_bones(skeleton: Skeleton, names: tuple[str, ...], roles: dict[str, int]) -> Bones:
    """Select bones of a skeleton and find the tree between them.

    Parameters
    ----------
    skeleton : Skeleton
        Source skeleton.
    names : tuple of str
        Joints that move something, any order, each once.
    roles : dict of str to int
        Body role to joint index of the skeleton.

    Returns
    -------
    Bones
        In the order of the skeleton.
    """
    joints = np.array(sorted(skeleton.index(name) for name in names), dtype=np.int64)
    place = {int(j): b for b, j in enumerate(joints)}
    parents = np.full(len(joints), -1, dtype=np.int64)
    for b, j in enumerate(joints):
        above = int(skeleton.parents[j])
        while above >= 0 and above not in place:
            above = int(skeleton.parents[above])
        parents[b] = place.get(above, -1)
    role_of = {joint: role for role, joint in roles.items()}
    return Bones(
        tuple(skeleton.names[j] for j in joints),
        tuple(role_of.get(int(j), "") for j in joints),
        joints,
        parents,
    )


def split_role(role: str) -> tuple[str, str]:
    """Split a role into side and part.

    Parameters
    ----------
    role : str
        Such as ``"left_forearm"`` or ``"chest"``.

    Returns
    -------
    side, part : str
        ``("left_", "forearm")``, or ``("", "chest")``.
    """
    for side in ("left_", "right_"):
        if role.startswith(side):
            return side, role[len(side) :]
    return "", role


def bone_spans(
    skeleton: Skeleton,
    joints: IntArray,
    roles: dict[str, int],
    rotations: FloatArray,
    root_position: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Place bones in the world: how each is turned, where it starts and where it ends.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    joints : (B,) int
        Joints at which the bones start.
    roles : dict of str to int
        Body role to joint, which tells where a bone ends when several joints follow.
    rotations : (..., J, 4) float
        Local rotations wxyz.
    root_position : (..., 3) float
        World position of the root, metres.

    Returns
    -------
    turns : (..., B, 4) ndarray
        World rotations.
    starts, ends : (..., B, 3) ndarray
        Metres. A bone ends at the joint of the next role, at a child, or at its tip; an end equal to the
        start means that none is known.
    """
    world, positions = forward_kinematics(skeleton, rotations, root_position)
    starts = positions[..., joints, :]
    ends = np.array(starts)
    of_role = bone_ends(skeleton, roles)
    role_of = {joint: role for role, joint in roles.items()}
    for b, j in enumerate(int(j) for j in joints):
        end = of_role.get(role_of[j]) if j in role_of else _plain_end(skeleton, j)
        if end is None:
            continue
        ends[..., b, :] = positions[..., end.end, :]
        if end.tip is not None:
            ends[..., b, :] += rotate(world[..., end.end, :], end.tip)
    return world[..., joints, :], starts, ends


def _plain_end(skeleton: Skeleton, j: int) -> BoneEnd | None:
    """End of a bone without a role: its only child, the farthest of several, or its tip."""
    children = skeleton.children(j)
    if len(children):
        reach = np.linalg.norm(skeleton.offsets[children], axis=1)
        return BoneEnd(j, int(children[reach.argmax()]))
    tip = np.asarray(skeleton.tips)[j]
    return BoneEnd(j, j, tip) if np.isfinite(tip).all() else None
