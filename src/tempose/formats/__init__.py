"""Clips from and to files, one file a format; everything is converted here and nowhere else."""

from tempose.formats.conventions import UNITS, FormatError
from tempose.formats.describe import describe
from tempose.formats.registry import (
    FORMATS,
    load,
    load_clip,
    load_mesh,
    load_skeleton_clip,
    load_skin,
)
from tempose.formats.saving import save
from tempose.formats.skin_saving import save_skin

__all__ = [
    "FORMATS",
    "UNITS",
    "FormatError",
    "describe",
    "load",
    "load_clip",
    "load_mesh",
    "load_skeleton_clip",
    "load_skin",
    "save",
    "save_skin",
]
