"""Where the bone of each role points, from its joint to the next one that is not on the same spot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics._joint_tree import JointTree
from tempose.kinematics._limbs import ARM, LEG
from tempose.kinematics.forward import rest_transforms
from tempose.kinematics.roles import TRUNK
from tempose.rotations import rotate
from tempose.typing import FloatArray

_CHAINS = (
    TRUNK,
    *(tuple(f"{side}_{part}" for part in parts) for side in ("left", "right") for parts in (ARM, LEG)),
)
_NO_FINGER = re.compile(r"thumb|carpal|base|attach|prop|weapon", re.IGNORECASE)
_END = re.compile(r"^__|end|nub|leaf|tip|top|site", re.IGNORECASE)


@dataclass(frozen=True)
class BoneEnd:
    """Two ends of a bone: a joint, and another joint or a tip in the basis of the first."""

    start: int
    """Joint at which the bone starts."""
    end: int
    """Joint at which it ends; not used where a tip is given."""
    tip: FloatArray | None = None
    """(3,) metres, in the basis of `start`."""


def bone_ends(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, BoneEnd]:
    """Find where the bone of each role ends.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    roles : mapping of str to int
        From `find_roles`.

    Returns
    -------
    dict of str to BoneEnd
        Forearm to hand, hand to its middle finger, foot to toes, hips to spine, head and toes to their
        tips; joints on the same spot are skipped. A bone of unknown length continues the one before it.
    """
    tree = _Spots(skeleton)
    ends: dict[str, BoneEnd] = {}
    for chain in _CHAINS:
        present = [roles[role] for role in chain if role in roles]
        for role in (role for role in chain if role in roles):
            joint = roles[role]
            later = present[present.index(joint) + 1 :]
            before = present[: present.index(joint)]
            end = (
                _next_joint(tree, joint, later)
                or _terminal(tree, role, joint)
                or _continued(tree, joint, before)
            )
            if end is not None:
                ends[role] = end
    return ends


def bone_axis(
    skeleton: Skeleton, world_positions: FloatArray, world_rotations: FloatArray, roles: Mapping[str, int]
) -> dict[str, FloatArray]:
    """Vector along the bone of each role.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    world_positions : (..., J, 3) float
        Joint positions, metres.
    world_rotations : (..., J, 4) float
        Rotations of the joints' bases in the world, wxyz.
    roles : mapping of str to int
        From `find_roles`.

    Returns
    -------
    dict of str to (..., 3) ndarray
        From the role's joint to the end of its bone, metres; see `bone_ends`.
    """
    axes: dict[str, FloatArray] = {}
    for role, bone in bone_ends(skeleton, roles).items():
        if bone.tip is None:
            axes[role] = world_positions[..., bone.end, :] - world_positions[..., bone.start, :]
        else:
            axes[role] = rotate(world_rotations[..., bone.start, :], bone.tip)
    return axes


def role_lengths(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, float]:
    """Length of the bone of each role in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    roles : mapping of str to int
        From `find_roles`.

    Returns
    -------
    dict of str to float
        Metres.
    """
    rotations, positions = rest_transforms(skeleton)
    axes = bone_axis(skeleton, positions, rotations, roles)
    return {role: float(np.linalg.norm(axis)) for role, axis in axes.items()}


class _Spots(JointTree):
    """A tree that knows which joints lie on the same spot at rest."""

    def __init__(self, skeleton: Skeleton) -> None:
        super().__init__(skeleton)
        self.steps = np.linalg.norm(skeleton.offsets, axis=1)
        self.positions = rest_transforms(skeleton)[1]
        self.small = 1e-6 * float(self.steps[1:].sum())

    def apart(self, a: int, b: int) -> bool:
        """Whether two joints lie on different spots."""
        return bool(np.linalg.norm(self.positions[a] - self.positions[b]) > self.small)

    def elsewhere(self, joint: int) -> list[int]:
        """All joints strictly below one and on another spot."""
        return [j for j, up in enumerate(self.up) if joint in up[1:] and self.apart(joint, j)]

    def topmost(self, joints: list[int]) -> list[int]:
        """Those without one of the others above them."""
        return [j for j in joints if not set(self.up[j][1:]) & set(joints)]


def _next_joint(tree: _Spots, joint: int, later: list[int]) -> BoneEnd | None:
    here = joint
    for target in later:
        # beyond the first target every joint on the way will do
        steps = [target] if here == joint else tree.path(here, target)
        for j in steps:
            if tree.apart(joint, j):
                return BoneEnd(joint, j)
        here = target
    return None


def _terminal(tree: _Spots, role: str, joint: int) -> BoneEnd | None:
    names, below = tree.names, tree.elsewhere(joint)
    if role.endswith("hand"):
        fingers = [
            j for j in below if tree.read[j][1] in ("finger", "hand") and not _NO_FINGER.search(names[j])
        ]
        fingers = sorted(tree.topmost(fingers), key=lambda j: names[j])
        if fingers:
            middle = [j for j in fingers if "middle" in names[j].lower()]
            return BoneEnd(joint, (middle or [fingers[len(fingers) // 2]])[0])
    assert tree.skeleton.tips is not None
    tip = tree.skeleton.tips[joint]
    if np.linalg.norm(tip) > tree.small:
        return BoneEnd(joint, joint, tip)
    children = tree.topmost(below)
    ends = [j for j in children if _END.search(names[j])]
    if role not in TRUNK:
        ends = ends or sorted(children, key=lambda j: -tree.steps[j])
    return BoneEnd(joint, ends[0]) if ends else None


def _continued(tree: _Spots, joint: int, before: list[int]) -> BoneEnd | None:
    starts = [j for j in reversed(before) if tree.apart(j, joint)]
    return BoneEnd(starts[0], joint) if starts else None
