"""A skeleton with its names read and its ancestors known."""

from __future__ import annotations

from tempose.clips import Skeleton
from tempose.kinematics.joint_names import read_names


class JointTree:
    """A skeleton with its names read and its ancestors known."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton = skeleton
        self.names = skeleton.names
        self.read = read_names(skeleton.names)
        self.up: list[list[int]] = []
        for j, parent in enumerate(skeleton.parents):
            self.up.append([j, *(self.up[parent] if parent >= 0 else [])])

    def of(self, side: str, *parts: str) -> list[int]:
        """Joints of a part, outermost ancestors first."""
        found = [j for j, read in enumerate(self.read) if read[0] == side and read[1] in parts]
        return sorted(found, key=lambda j: len(self.up[j]))

    def below(self, joints: list[int], above: int | None) -> list[int]:
        """Those of the joints that are strictly below one."""
        return joints if above is None else [j for j in joints if above in self.up[j][1:]]

    def common(self, joints: list[int]) -> int | None:
        """Nearest joint at or above all of them."""
        shared = set[int].intersection(*(set(self.up[j]) for j in joints)) if joints else set[int]()
        return max(shared, key=lambda j: len(self.up[j]), default=None)

    def first(self, joints: list[int]) -> int | None:
        """Nearest to the root; of several the one that carries most joints, of toes the first by name."""
        if not joints:
            return None
        depth = len(self.up[joints[0]])
        level = [j for j in joints if len(self.up[j]) == depth]
        if self.read[level[0]][1] == "toes":
            return min(level, key=lambda j: self.names[j])
        return max(level, key=lambda j: (sum(j in up for up in self.up), -j))

    def path(self, a: int, b: int) -> list[int]:
        """Joints on the way from `a` (left out) to `b`."""
        shared = set(self.up[a]) & set(self.up[b])
        fork = next(j for j in self.up[b] if j in shared)
        climb = [*(j for j in self.up[a] if j not in shared), fork][1:] if fork != a else []
        return climb + [j for j in self.up[b] if j not in shared][::-1]
