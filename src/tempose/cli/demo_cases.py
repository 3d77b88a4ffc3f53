"""What `tempose demo` shows: built-in motions, performed by other bodies than those they move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import tempose

if TYPE_CHECKING:
    from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh

FPS = 30.0
TRIANGLES = 20_000


@dataclass(frozen=True)
class Case:
    """One transfer."""

    name: str
    """Name of its files."""
    title: str
    """For a heading."""
    about: str
    """What to look for."""
    motion: Callable[[], SkeletonClip]
    """Makes the source."""
    target: str
    """``"human"`` or ``"animal"``."""
    film: bool = False
    """Whether it is worth a film."""


def make_target(kind: str) -> SkinnedMesh:
    """Make a built-in character.

    Parameters
    ----------
    kind : str
        ``"human"`` or ``"animal"``.

    Returns
    -------
    SkinnedMesh
        In its rest pose; its skin weights say which triangles to mark.
    """
    return tempose.samples.CHARACTERS[kind](TRIANGLES)


def _performer(skeleton: Skeleton, scale: float, limbs: float) -> Skeleton:
    """Another body: larger or smaller as a whole, its arms and legs longer or shorter than that."""
    factors = [
        scale * (limbs if any(part in name for part in ("forearm", "shin", "hand", "foot")) else 1.0)
        for name in skeleton.names
    ]
    offsets = skeleton.offsets * [[factor] for factor in factors]
    tips = None if skeleton.tips is None else skeleton.tips * scale
    return replace(skeleton, offsets=offsets, tips=tips)


def _human_motion(name: str, scale: float, limbs: float, seconds: float) -> Callable[[], SkeletonClip]:
    def make() -> SkeletonClip:
        skeleton = _performer(tempose.samples.human_skeleton(), scale, limbs)
        return tempose.samples.MOTIONS["human"][name](skeleton, duration=seconds, fps=FPS)

    return make


def _animal_motion(name: str, scale: float, seconds: float) -> Callable[[], SkeletonClip]:
    def make() -> SkeletonClip:
        skeleton = _performer(tempose.samples.animal_skeleton(), scale, 1.0)
        return tempose.samples.MOTIONS["animal"][name](skeleton, duration=seconds, fps=FPS)

    return make


CASES = (
    Case(
        "human_walk",
        "A walk",
        "A small person with long limbs walks; the character is taller. Feet in contact must stand still.",
        _human_motion("walk", 0.85, 1.1, 2.4),
        "human",
        film=True,
    ),
    Case(
        "human_run",
        "A run",
        "A tall runner; both feet are off the ground between steps, so placement has to bridge the flight.",
        _human_motion("run", 1.15, 0.95, 1.6),
        "human",
    ),
    Case(
        "human_jump",
        "A jump",
        "Deep bends of hips and knees: where surfaces lose volume first.",
        _human_motion("jump", 1.0, 1.08, 3.0),
        "human",
    ),
    Case(
        "animal_gallop",
        "A gallop",
        "The same method on four legs, performed by a larger animal.",
        _animal_motion("gallop", 1.3, 1.6),
        "animal",
    ),
)
