"""Clips from nothing: procedural characters and motions with known truth."""

from tempose.samples.character import (
    CHARACTERS,
    Character,
    animal,
    animal_character,
    human,
    human_character,
)
from tempose.samples.motions import MOTIONS, find_motion
from tempose.samples.secondary import secondary_motion
from tempose.samples.skeletons import animal_skeleton, human_skeleton

__all__ = [
    "CHARACTERS",
    "MOTIONS",
    "Character",
    "animal",
    "animal_character",
    "animal_skeleton",
    "find_motion",
    "human",
    "human_character",
    "human_skeleton",
    "secondary_motion",
]
