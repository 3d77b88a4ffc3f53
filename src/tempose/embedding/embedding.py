"""What `embed_skeleton` returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.clips import Skeleton
from tempose.embedding.human import NAMES, PARENTS, joint_skeleton, role_skeleton
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Embedding:
    """A human skeleton inside a mesh, in the mesh's own coordinates."""

    joints: FloatArray
    """(18, 3) float64, positions in the order of `names`."""
    ends: Mapping[str, FloatArray]
    """Far end (3,) of the bones that end at no joint: head, hands, toes."""
    penalty: float
    """How unlike a human the body is: 0 as the average person, 1 where `doubtful` begins."""
    facing: FloatArray
    """(3, 3) float64 rotation from the mesh's axes to Y up, +Z front."""
    up: str = "+y"
    """Axis of the mesh that points up along the body, such as ``"+z"``."""
    reasons: tuple[str, ...] = ()
    """Why the embedding is doubted, for a person to read; empty when it is not."""
    report: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """Measures and seconds a stage."""

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        set_(self, "joints", read_only(as_floats(self.joints, "joints", (len(NAMES), 3))))
        set_(self, "facing", read_only(as_floats(self.facing, "facing", (3, 3))))
        ends = {k: read_only(as_floats(v, f"ends[{k!r}]", (3,))) for k, v in self.ends.items()}
        set_(self, "ends", MappingProxyType(ends))
        set_(self, "report", MappingProxyType(dict(self.report)))

    @property
    def names(self) -> tuple[str, ...]:
        """The 18 joints, by their role in the body."""
        return NAMES

    @property
    def parents(self) -> IntArray:
        """(18,) int32, parent of each joint, -1 for the hips."""
        return np.array(PARENTS, dtype=np.int32)

    @property
    def doubtful(self) -> bool:
        """Whether the body may not be human, or not as it was placed."""
        return bool(self.reasons)

    @property
    def confidence(self) -> float:
        """From 1, as human as the average, through 0.5 where doubt begins, to 0."""
        return float(1.0 / (1.0 + self.penalty**2))

    @cached_property
    def skeleton(self) -> Skeleton:
        """All 21 body roles: the 18 joints, chest and clavicles."""
        return role_skeleton(self.joints, dict(self.ends))

    @cached_property
    def joint_skeleton(self) -> Skeleton:
        """The 18 joints alone."""
        return joint_skeleton(self.joints, self.ends)
