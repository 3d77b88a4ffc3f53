"""Clips from nothing: procedural characters and motions with known truth."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tempose.samples.baking import sample_clip
    from tempose.samples.character import CHARACTERS, Character, animal_character, human_character
    from tempose.samples.motion_clip import SampleMotion, sole_positions
    from tempose.samples.motions import MOTIONS
    from tempose.samples.secondary import secondary_motion
    from tempose.samples.skeletons import animal_skeleton, human_skeleton

__all__ = [
    "CHARACTERS",
    "MOTIONS",
    "Character",
    "SampleMotion",
    "animal_character",
    "animal_skeleton",
    "human_character",
    "human_skeleton",
    "sample_clip",
    "secondary_motion",
    "sole_positions",
]

_HOME = {
    "CHARACTERS": "character",
    "Character": "character",
    "MOTIONS": "motions",
    "SampleMotion": "motion_clip",
    "animal_character": "character",
    "animal_skeleton": "skeletons",
    "human_character": "character",
    "human_skeleton": "skeletons",
    "sample_clip": "baking",
    "secondary_motion": "secondary",
    "sole_positions": "motion_clip",
}


def __getattr__(name: str) -> Any:
    # sculptor and motions are imported when first used: importing this package costs nothing
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
